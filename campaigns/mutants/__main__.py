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
from collections import Counter

from host import Host, Settings
from judge import Judge, Worker
from operators import mutants_of
from reach import Reach
from results import Results, accepted, folder_of, source_hash, table, write_accepted, write_json
from shop import Stop, copy_tree, digest, tree_files

WORKERS = 2
# files that no mutant is made of, each with its reason
LEFT_OUT = {"firmware/reply_packed.h": "written by tools/pack_texts.py, which make check runs"}
# their programs are not built here yet
OTHER_PROGRAMS = ("lib/nav/", "firmware/nav/", "hal/avr/", "lib/filters/src/fx_avr.h", "firmware/main.c")


def say(text):
    print(f"mutants: {text}", flush=True)


def options_of(arguments):
    parser = argparse.ArgumentParser(prog="mutants", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="prefix of the files' paths")
    parser.add_argument("--sample", type=int, default=0, help="so many, drawn by the tree's hash")
    parser.add_argument("--seed", default="", help="draw by these words instead")
    parser.add_argument("--seconds", type=float, default=0, help="stop after so long; the next run goes on")
    parser.add_argument("--accept", action="store_true", help="write the survivors to accepted.txt")
    return parser.parse_args(arguments)


def sources(only):
    found = [name for name in tree_files() if name.startswith(("lib/", "firmware/", "hal/")) and name.endswith((".c", ".h"))
             and name.startswith(only) and name not in LEFT_OUT and "/examples/" not in name and not name.startswith(OTHER_PROGRAMS)]
    if not found:
        raise Stop(f"no source of lib, firmware or hal begins with {only}")
    return found


def tree_hash():
    """Of what git would commit now, where there is git; else of the files."""
    done = subprocess.run(["git", "rev-parse", "HEAD^{tree}"], capture_output=True, text=True)
    return done.stdout.strip()[:12] or digest(*(pathlib.Path(n).read_bytes() for n in tree_files()))


def drawn(mutants, options):
    if not options.sample or options.sample >= len(mutants):
        return mutants
    seed = options.seed or tree_hash()
    say(f"{options.sample} of {len(mutants)}, drawn by {seed}")
    return random.Random(seed).sample(mutants, options.sample)


class Campaign:
    def __init__(self, options):
        self.options, self.began = options, time.monotonic()
        self.texts = {name: pathlib.Path(name).read_text(encoding="utf-8") for name in sources(options.only)}
        self.hashes = {name: source_hash(text) for name, text in self.texts.items()}
        self.mutants = drawn([m for name, text in self.texts.items() for m in mutants_of(name, text)], options)
        self.results = Results(digest(*(f"{n} {source_hash(pathlib.Path(n).read_bytes())}" for n in tree_files() if n.endswith((".c", ".h", ".cpp", ".hpp")))))
        self.kills = Counter()
        self.accepted = accepted()

    def prepare(self, pool):
        self.workers = queue.SimpleQueue()
        trees = [copy_tree(number) for number in range(WORKERS)]
        for number, tree in enumerate(trees):
            self.workers.put(Worker(number, tree))
        settings = Settings()
        self.tests = [t for t in settings.tests if not t.startswith("test_nav") and t != "test_simrun_judge"]
        hosts = [Host(settings, variant, trees[0]) for variant in ("ubsan", "asan")]
        say(f"building {len(settings.product)} sources and {len(self.tests)} tests, twice")
        for host in hosts:
            host.compile_all(pool, self.tests)
            host.link_product()
            list(pool.map(host.link_test, self.tests))
        self.host = hosts[0]
        files = {m.file for m in self.mutants}
        units = [s for s in settings.product if s in files or files & set(self.host.objects.deps(s))]
        self.reach = Reach(self.host, units)
        self.reach.measure(pool, self.tests, say)
        limits = {("ubsan", test): seconds for test, seconds in self.reach.seconds.items()}
        self.judge = Judge(hosts, self.order, limits)
        self.spans = {}

    def order(self, mutant):
        """The tests that reach it: cheap ones first, and those that killed others of this file."""
        text = self.texts[mutant.file]
        includers = [s for s in self.reach.files if mutant.file in self.host.objects.deps(s)] if mutant.file.endswith(".h") else []
        tests = self.reach.tests_of(mutant.file, mutant.line(text), self.span(mutant), includers)
        return sorted(tests, key=lambda t: self.reach.seconds[t] / (1 + self.kills[mutant.file, t]))

    def span(self, mutant):
        """The lines of all mutants of the same function."""
        key = mutant.file, mutant.owner
        if not self.spans:
            for name, text in self.texts.items():
                for other in mutants_of(name, text):
                    self.spans.setdefault((name, other.owner), set()).add(other.line(text))
        return self.spans[key]

    def one(self, mutant):
        kept = self.results.get(mutant, self.hashes[mutant.file])
        if kept:
            return kept
        if self.options.seconds and time.monotonic() - self.began > self.options.seconds:
            return None
        worker, began = self.workers.get(), time.monotonic()
        try:
            verdict, by = self.judge.verdict(mutant, worker)
        finally:
            self.workers.put(worker)
        if by:
            self.kills[mutant.file, by] += 1
        return self.results.put(mutant, self.hashes[mutant.file], mutant.line(self.texts[mutant.file]), verdict, by, time.monotonic() - began)

    def run(self):
        rows, told = [], 0
        with concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
            self.prepare(pool)
            try:
                for number, row in enumerate(pool.map(self.one, self.mutants), 1):
                    rows += [row] if row else []
                    if row and row["verdict"] == "survived" and row["key"] not in self.accepted:
                        print(f"survived: {row['key']} (line {row['line']})", flush=True)
                    if time.monotonic() - told > 15:
                        told = time.monotonic()
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
            say(f"{len(survived)} survivors written to campaigns/mutants/accepted.txt")
            new = []
        print(f"{len(killed) + len(survived) - len(new)} passed, {len(new)} failed")
        return 1 if new else 0


def main():
    try:
        campaign = Campaign(options_of(sys.argv[1:]))
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
