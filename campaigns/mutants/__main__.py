"""Mutants by operators: each is one small change of the product that some test must notice.

    make mutants                    all (hours; goes on where it stopped)
    make mutants ONLY=lib/tilt      those of files whose path begins so
    make mutants SAMPLE=25          so many of the folders in goals.txt, drawn by the tree's hash: fails on a survivor that is not accepted
"""
import argparse
import concurrent.futures
import os
import pathlib
import queue
import random
import subprocess
import sys
import time

from chip import ONLY_CHIP, Chip
from host import Host, Settings
from judge import Judge, Worker
from nav import Link, Variants
from operators import mutants_of
from order import Cheapest, Listed, Reached, write_judges
from results import Results, accepted, below_goal, folder_of, measured, table, write_accepted, write_goals, write_json
from shop import Stop, alone, copy_tree, digest, tree_files

WORKERS = 2
# files that no mutant is made of, each with its reason
LEFT_OUT = {"firmware/reply_packed.h": "written by tools/pack_texts.py, which make check runs",
            "firmware/nav/main.c": "20 lines that only the navigation image runs, whose test takes minutes"}
NAV = ("lib/nav/", "firmware/nav/")


def say(text):
    print(f"mutants: {text}", flush=True)


def options_of(arguments):
    parser = argparse.ArgumentParser(prog="mutants", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="prefix of the files' paths")
    parser.add_argument("--sample", type=int, default=0, help="so many, drawn by the tree's hash")
    parser.add_argument("--seed", default="", help="draw by these words instead")
    parser.add_argument("--seconds", type=float, default=0, help="stop after so long; the next run goes on")
    parser.add_argument("--patience", type=float, default=0, help="without tests that take longer, in seconds (0: all)")
    parser.add_argument("--accept", action="store_true", help="write the survivors to accepted.txt")
    return parser.parse_args(arguments)


def sources(options):
    """The files that mutants are made of; a sample's are in the folders whose whole measurement is known."""
    folders = measured() if options.sample else ["lib, firmware, hal"]
    if not folders:
        raise Stop("no folder in campaigns/mutants/goals.txt was measured whole, so no sample can be judged: make mutants ONLY=folder ACCEPT=1")
    product = [name for name in tree_files() if name.startswith(("lib/", "firmware/", "hal/")) and name.endswith((".c", ".h"))
               and name not in LEFT_OUT and "/examples/" not in name]
    found = [name for name in product if name.startswith(options.only) and (not options.sample or folder_of(name) in folders)]
    if not found:
        raise Stop(f"no source in {', '.join(folders)} begins with {options.only}")
    return found


def tree_hash():
    """Of what git would commit now, where there is git; else of the files."""
    done = subprocess.run(["git", "rev-parse", "HEAD^{tree}"], capture_output=True, text=True)
    return done.stdout.strip()[:12] or digest(*(pathlib.Path(n).read_bytes() for n in tree_files()))


def chosen(mutants, known, options):
    """All, in an order drawn by lot so that a campaign cut short is a fair sample; or a sample of those that a test is known to notice."""
    if not options.sample:
        return random.Random(0).sample(mutants, len(mutants))
    seed, noticed = options.seed or tree_hash(), [m for m in mutants if m.key not in known]
    say(f"{options.sample} of {len(noticed)} in {', '.join(measured())}, drawn by {seed}")
    return random.Random(seed).sample(noticed, min(options.sample, len(noticed)))


class Campaign:
    def __init__(self, options):
        self.options, self.began = options, time.monotonic()
        self.texts = {name: pathlib.Path(name).read_text(encoding="utf-8") for name in sources(options)}
        self.hashes = {name: digest(text) for name, text in self.texts.items()}
        self.accepted = accepted()
        self.mutants = chosen([m for name, text in self.texts.items() for m in mutants_of(name, text)], self.accepted, options)
        code = [n for n in tree_files() if n.endswith((".c", ".h", ".cpp", ".hpp"))]
        self.results = Results(digest(options.patience, *(pathlib.Path(n).read_bytes() for n in code)))

    def prepare(self, pool):
        self.workers = queue.SimpleQueue()
        for number in range(WORKERS):
            self.workers.put(Worker(number, copy_tree(number)))
        settings = Settings()
        hosts = [Host(settings, variant, copy_tree("clean")) for variant in ("ubsan", "asan")]
        say(f"building {len(settings.product)} sources of the PC's programs")
        hosts[0].compile(pool)
        self.order = Listed(settings.tests) if self.options.sample else Reached(
            hosts[0], self.mutants, self.texts, self.options.patience, pool, say)
        self.judge, self.chip = Judge(hosts, self.order.tests, self.order.limits), Chip(hosts[0].tree)
        self.cheapest, link = Cheapest(self.options.patience), Link(settings, hosts[0].tree)
        self.nav = Judge([Variants(settings, hosts[0].tree, hosts[0]), link], self.cheapest.tests, self.cheapest.limits)
        self.nav_link = Judge([link], self.cheapest.tests, self.cheapest.limits)

    def judge_of(self, file):
        """(judge, who learns from it)"""
        if file.startswith(ONLY_CHIP):
            return self.chip, self.cheapest
        if file.startswith(NAV):
            return self.nav if file.startswith("lib/") else self.nav_link, self.cheapest
        return self.judge, self.order

    def one(self, mutant):
        kept = self.results.get(mutant, self.hashes[mutant.file])
        if kept:
            return kept
        if self.options.seconds and time.monotonic() - self.began > self.options.seconds:
            return None
        worker, began = self.workers.get(), time.monotonic()
        judge, learner = self.judge_of(mutant.file)
        try:
            verdict, by = judge.verdict(mutant, worker)
        finally:
            self.workers.put(worker)
        learner.learn(mutant, by)
        return self.results.put(mutant, self.hashes[mutant.file], mutant.line(self.texts[mutant.file]), verdict, by, time.monotonic() - began)

    def run(self):
        rows, shown = [], time.monotonic()
        with concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
            self.prepare(pool)
            try:
                for number, row in enumerate(pool.map(self.one, self.mutants), 1):
                    rows += [row] if row else []
                    if row and row["verdict"] == "survived" and row["key"] not in self.accepted:
                        print(f"survived: {row['key']} (line {row['line']})", flush=True)
                    if time.monotonic() - shown > 15:
                        shown = time.monotonic()
                        say(f"{number} of {len(self.mutants)}, {sum(r['verdict'] == 'killed' for r in rows)} killed")
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                raise
        return rows

    def report(self, rows):
        survived = [row["key"] for row in rows if row["verdict"] == "survived"]
        killed = [row["key"] for row in rows if row["verdict"] == "killed"]
        write_json(rows)
        print(table(rows, lambda r: r["file"], "file"))
        print(table(rows, lambda r: folder_of(r["file"]), "folder"))
        new = sorted(set(survived) - self.accepted)
        for key in sorted(self.accepted & set(killed)):
            say(f"killed now, so it can leave the list: {key}")
        if len(rows) < len(self.mutants):
            say(f"{len(self.mutants) - len(rows)} left: make mutants goes on with them")
        if self.options.accept:
            write_accepted(rows)
            write_judges(rows)
            if len(rows) == len(self.mutants):
                write_goals(rows, self.options.only)
            say(f"{len(survived)} survivors written to campaigns/mutants/accepted.txt")
            new = []
        low = [] if self.options.sample or len(rows) < len(self.mutants) else below_goal(rows)
        for text in low:
            say(text)
        print(f"{len(killed) + len(survived) - len(new)} passed, {len(new) + len(low)} failed")
        return 1 if new or low else 0


def main():
    try:
        options = options_of(sys.argv[1:])
        with alone():
            campaign = Campaign(options)
            return campaign.report(campaign.run())
    except Stop as why:
        print(f"mutants: {why}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("mutants: stopped; the next run goes on from here", file=sys.stderr)
        return 130


if __name__ == "__main__":
    os.environ.setdefault("PYTHONDONTWRITEBYTECODE", "1")
    sys.exit(main())
