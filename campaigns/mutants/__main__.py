"""Mutants by operators: each is one small change of the product that some test must notice.

    make mutants                    all (hours; goes on where it stopped), into docs/results/mutants.md
    make mutants ONLY=lib/tilt      those of a folder in goals.txt, or of files whose path begins so
    make mutants SAMPLE=25          so many of the folders in goals.txt, drawn by the tree's hash: fails on a survivor that is not accepted where
                                    all are known, else when their goal is missed
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

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path += [str(ROOT / folder) for folder in (ROOT / "mk/pythonpath").read_text(encoding="ascii").split()]
import page_mutants  # noqa: E402
import page_sources  # noqa: E402
from chip import ONLY_CHIP, Chip
from host import Host, Settings
from judge import Judge, Worker
from nav import Link, Variants
from operators import mutants_of
from order import Cheapest, Listed, Reached, write_judges
from shop import Stop, alone, copy_tree, digest, tree_files
from verdicts import (Results, accepted, below_goal, folder_of, goals, may_survive, measured, missed_by_sample, sampled, table, write_accepted,
                      write_goals, write_json)

WORKERS = 2
# files that no mutant is made of, each with its reason
LEFT_OUT = {"firmware/console/reply_packed.h": "written by mk/scripts/pack_texts.py, which make check runs",
            "nav/image/main.c": "20 lines that only the navigation image runs, whose test takes minutes"}
NAV = ("nav/lib/", "nav/image/")


def say(text):
    print(f"mutants: {text}", flush=True)


def above_zero(name, kind):
    """Reads a number of make's line; nothing is 0."""
    def read(text):
        try:
            value = kind(text or 0)
        except ValueError:
            value = -1
        if not (0 < value < float("inf") or not text):
            raise Stop(f"{name}={text} is no {'whole number' if kind is int else 'number of seconds'} above 0; without {name} "
                       f"{'all are judged' if kind is int else 'there is no limit'}")
        return value
    return read


def options_of(arguments):
    parser = argparse.ArgumentParser(prog="mutants", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="a folder in goals.txt, or a prefix of the files' paths")
    parser.add_argument("--sample", type=above_zero("SAMPLE", int), default=0, help="so many, drawn by the tree's hash")
    parser.add_argument("--seed", default="", help="draw by these words instead")
    parser.add_argument("--seconds", type=above_zero("STOP_AFTER", float), default=0, help="stop after so long; the next run goes on")
    parser.add_argument("--patience", type=above_zero("PATIENCE", float), default=0, help="without tests that take longer, in seconds")
    parser.add_argument("--accept", action="store_true", help="write the survivors to accepted.txt")
    options = parser.parse_args(arguments)
    if options.accept and options.sample:
        raise Stop("ACCEPT=1 wants every mutant of the chosen files, not a sample of them: leave SAMPLE out")
    return options


def product():
    return [name for name in tree_files() if name.startswith(("lib/", "firmware/", *NAV, "hal/")) and name.endswith((".c", ".h"))
            and name not in LEFT_OUT and "/examples/" not in name]


def digests():
    """folder -> digest of its sources now."""
    texts = {}
    for name in product():
        texts.setdefault(folder_of(name), []).append(pathlib.Path(name).read_bytes())
    return {folder: digest(*parts)[:12] for folder, parts in texts.items()}


def sources(options):
    """The files that mutants are made of; a sample's are in the folders that one may be drawn from."""
    folders = sampled(digests()) if options.sample else ["lib, firmware, hal"]
    if not folders:
        raise Stop("no folder in campaigns/mutants/goals.txt has a goal or is as it was measured, so no sample can be judged: "
                   "make mutants ONLY=folder ACCEPT=1")
    wanted = (lambda name: folder_of(name) == options.only) if options.only in goals() else lambda name: name.startswith(options.only)
    found = [name for name in product() if wanted(name) and (not options.sample or folder_of(name) in folders)]
    if not found:
        raise Stop(f"no source in {', '.join(folders)} begins with {options.only}")
    return found


def whole_folders(files):
    """The folders of which no file that mutants are made of is missing here."""
    return {folder_of(name) for name in files} - {folder_of(name) for name in product() if name not in files}


def head_tree():
    """The tree of the last commit: a sample is the same as often as it is judged, and another one with the next change."""
    done = subprocess.run(["git", "rev-parse", "HEAD^{tree}"], capture_output=True, text=True)
    if done.returncode != 0:
        raise Stop("git knows no commit to draw a sample by: commit first")
    return done.stdout.strip()[:12]


def chosen(mutants, known, options):
    """All, in an order drawn by lot so that a campaign cut short is a fair sample, the navigation filter's last; by a digest, so that it is the
    same for each choice of files and after each change. Or a sample of those that a test is known to notice."""
    if not options.sample:
        return sorted(mutants, key=lambda mutant: (mutant.file.startswith(NAV), digest("0", mutant.key)))
    seed, noticed = options.seed or head_tree(), [m for m in mutants if m.key not in known]
    say(f"{options.sample} of {len(noticed)} in {', '.join(sorted({folder_of(m.file) for m in mutants}))}, drawn by {seed}")
    return random.Random(seed).sample(noticed, min(options.sample, len(noticed)))


def has_page(options):
    """A campaign over all of the product by all tests, whole or cut short."""
    return not (options.only or options.sample or options.patience)


class Campaign:
    def __init__(self, options):
        self.options, self.began = options, time.monotonic()
        self.texts = {name: pathlib.Path(name).read_text(encoding="utf-8") for name in sources(options)}
        self.hashes = {name: digest(text) for name, text in self.texts.items()}
        self.accepted = accepted()
        every = [m for name, text in self.texts.items() for m in mutants_of(name, text)]
        self.shares = may_survive(every, self.accepted)
        self.mutants = chosen(every, self.accepted, options)
        if has_page(options):
            self.sources, self.equal = page_sources.hash_now(page_mutants.DOCUMENT), page_mutants.reasons({m.key for m in every})
        self.whole = whole_folders(self.texts)
        made_of = [n for n in tree_files() if n.endswith((".c", ".h", ".cpp", ".hpp", ".py", ".mk", "Makefile"))]
        self.results = Results(digest(options.patience, *(pathlib.Path(n).read_bytes() for n in made_of)))

    def prepare(self, pool):
        self.workers = queue.SimpleQueue()
        for number in range(WORKERS):
            self.workers.put(Worker(number, copy_tree(number)))
        settings = Settings()
        hosts = [Host(settings, variant, copy_tree("clean")) for variant in ("ubsan", "asan")]
        say(f"building {len(settings.product)} sources of the PC's programs")
        hosts[0].compile(pool)
        self.order = Listed(settings.tests, hosts[0].test_source) if self.options.sample else Reached(
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
            return self.nav if file.startswith(NAV[0]) else self.nav_link, self.cheapest
        return self.judge, self.order

    def one(self, mutant):
        # a sample is judged, whatever is known of it, and is no part of the whole campaign
        kept = None if self.options.sample else self.results.get(mutant, self.hashes[mutant.file])
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
        return self.results.put(mutant, self.hashes[mutant.file], mutant.line(self.texts[mutant.file]), verdict, by, time.monotonic() - began,
                                keep=not self.options.sample)

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

    def write_page(self, rows):
        if has_page(self.options):
            page_mutants.write(page_mutants.tables(self.mutants, rows, folder_of, self.equal), self.sources)
            say(f"{page_mutants.DOCUMENT} written")

    def report(self, rows):
        survived = [row["key"] for row in rows if row["verdict"] == "survived"]
        killed = [row["key"] for row in rows if row["verdict"] == "killed"]
        if not self.options.sample:
            write_json(rows)
        print(table(rows, lambda r: r["file"], "file"))
        print(table(rows, lambda r: folder_of(r["file"]), "folder"))
        new = set(survived) - self.accepted
        changed = {folder_of(row["file"]) for row in rows} - set(measured(digests())) if self.options.sample else set()
        new = {key for key in new if folder_of(key.partition(":")[0]) not in changed}
        for key in sorted(self.accepted & set(killed)):
            say(f"killed now, so it can leave the list: {key}")
        left = len(self.mutants) - len(rows)
        if left:
            say(f"{left} left: make mutants goes on with them")
        if self.options.accept and left:
            say(f"nothing is accepted: {left} of {len(self.mutants)} mutants have no verdict yet, so run make mutants ACCEPT=1 again")
        elif self.options.accept:
            self.accept(rows)
            new = set()
        low = missed_by_sample(rows, changed, self.shares) if self.options.sample else [] if left else below_goal(rows, self.whole)
        for text in low:
            say(text)
        print(f"{len(killed) + len(survived) - len(new)} passed, {len(new) + len(low)} failed")
        return 2 if self.options.accept and left else 1 if new or low else 0

    def accept(self, rows):
        write_accepted(rows, self.texts)
        write_judges(rows)
        write_goals(rows, self.whole, digests())
        say(f"{sum(row['verdict'] == 'survived' for row in rows)} survivors written to campaigns/mutants/accepted.txt")


def main():
    try:
        options = options_of(sys.argv[1:])
        with alone():
            campaign = Campaign(options)
            rows = campaign.run()
            campaign.write_page(rows)
            return campaign.report(rows)
    except (Stop, page_sources.Fault) as why:
        print(f"mutants: {why}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("mutants: stopped; the next run goes on from here", file=sys.stderr)
        return 130


if __name__ == "__main__":
    os.environ.setdefault("PYTHONDONTWRITEBYTECODE", "1")
    sys.exit(main())
