#!/usr/bin/env python3
"""make papers: runs the experiments of the papers side by side, judges each number against its accepted band and the paper's, writes
build/papers.json and the tables of docs/papers.md.

    papers.py [--paper NNN...] [--runs N] [--seed N] [--only WORD...]

--paper: only these papers, the others' part of the page and of the JSON stay. With --only, with fewer runs or with another seed page and JSON
are left alone.
"""
import argparse
import concurrent.futures
import json
import pathlib
import subprocess
import sys
import time

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import page
import page_sources
from papers_judge import BANDED, VERDICT_RUNS, Fault, judge, read_expected
from papers_page import DOCUMENT, write_page

# programs and accepted bands of each paper; a folder is a program in Python
PAPERS = {paper: (tuple(map(pathlib.Path, programs)), pathlib.Path(f"host_tests/papers/expected_{paper}.csv"))
          for paper, programs in (("000", ("build/papers/paper000",)), ("001", ("build/papers/paper001",)),
                                  ("002", ("build/papers/paper002", "build/papers/operations002")), ("003", ("build/papers/paper003",)),
                                  ("004", ("campaigns/variable_structure", "build/papers/paper004_board")))}
PYTHON = pathlib.Path("build/venv/bin/python")  # which has numpy
# runs that the programs make of --runs 10000, and what each shipped filter must have a band for
FULL_RUNS = {"000": 4000, "001": 2000, "002": VERDICT_RUNS, "003": 20, "004": 500}
WANTED = {"000": ("mse_2_5",), "001": ("sigma_stationary",), "002": BANDED, "003": (), "004": ()}
JSON = pathlib.Path("build/papers.json")
PAGE_RUNS, PAGE_SEED = 10000, 2024
WORKERS = 2
LIMIT_S = 900


class Bar:
    """Progress over all experiments, on a terminal only."""

    def __init__(self, works, stream=sys.stderr):
        self.works, self.done = works, {name: 0.0 for name in works}
        self.stream, self.began, self.last = stream, time.monotonic(), 0.0

    def text(self, now):
        part = sum(self.works[n] * self.done[n] for n in self.works) / sum(self.works.values())
        spent = now - self.began
        left = f"{spent * (1 - part) / part:.0f} s left" if part > 0.01 else "..."
        filled = int(30 * part)
        return f"papers [{'#' * filled}{'.' * (30 - filled)}] {100 * part:3.0f} %  {left}"

    def at(self, name, part):
        self.done[name] = min(1.0, part)
        now = time.monotonic()
        if self.stream.isatty() and now - self.last > 0.1:
            self.last = now
            self.stream.write(f"\r{self.text(now)}   ")
            self.stream.flush()

    def end(self):
        if self.stream.isatty():
            self.stream.write("\r" + " " * 70 + "\r")
            self.stream.flush()


def number(text):
    return float(text) if text else None


def command_of(program):
    if not program.is_dir():
        return [str(program)]
    if not PYTHON.exists():
        raise Fault(f"{program}: needs {PYTHON}, which is not there: sh tools/deps.sh papers")
    return [str(PYTHON), str(program)]


def run_one(program, experiment, options, bar):
    """Rows (dictionaries) that an experiment prints."""
    command = [*command_of(program), experiment, "--runs", str(options.runs), "--seed", str(options.seed)]
    rows, started = [], time.monotonic()
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        for line in process.stdout:
            cells = line.rstrip("\n").split("\t")
            if cells[0] == "progress":
                bar.at(experiment, float(cells[1]))
            elif cells[0] == "row" and len(cells) == 9:
                rows.append(dict(zip(("experiment", "filter", "arithmetic", "metric"), cells[1:5]),
                                 value=float(cells[5]), ci_lo=number(cells[6]), ci_hi=number(cells[7]), runs=int(cells[8])))
            else:
                process.kill()
                raise Fault(f"{experiment}: cannot read its line '{line.strip()}'")
            if time.monotonic() - started > LIMIT_S:
                process.kill()
                raise Fault(f"{experiment}: not at its end after {LIMIT_S} s")
        told = process.stderr.read().strip()
        if process.wait() != 0:
            raise Fault(f"{experiment}: {told or f'status {process.returncode}'}")
    if not rows:
        raise Fault(f"{experiment}: printed no row")
    bar.at(experiment, 1.0)
    return rows


def experiments_of(programs):
    """{experiment: (program, relative work)}."""
    found = {}
    for program in programs:
        done = subprocess.run([*command_of(program), "--list"], capture_output=True, text=True, timeout=600, check=False)
        if done.returncode != 0:
            raise Fault(f"{program} --list gave status {done.returncode}: {done.stderr.strip()}")
        for name, work in (line.split("\t") for line in done.stdout.splitlines()):
            found[name] = (program, float(work))
    return found


def chosen_of(words, only=()):
    """{paper: {experiment: (program, relative work)}} of the experiments whose name contains a word, or of all; of all papers or only some."""
    found = {paper: experiments_of(programs) for paper, (programs, _) in PAPERS.items() if not only or paper in only}
    chosen = {paper: {name: entry for name, entry in all_.items() if not words or any(w in name for w in words)} for paper, all_ in found.items()}
    if not any(chosen.values()):
        raise Fault(f"no experiment's name contains {' or '.join(words)}; there are {', '.join(name for all_ in found.values() for name in all_)}")
    return {paper: experiments for paper, experiments in chosen.items() if experiments}


def run_all(experiments, options):
    """Rows of all experiments, in the order of the list; two at a time, the longest first."""
    bar = Bar({name: work for name, (_, work) in experiments.items()})
    with concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
        try:
            parts = list(pool.map(lambda entry: run_one(entry[1][0], entry[0], options, bar), experiments.items()))
        finally:
            bar.end()
    return [row for part in parts for row in part]


def as_json(paper, rows):
    """A value that is not finite (never back) is null."""
    fields = ("experiment", "filter", "arithmetic", "metric", "value", "ci_lo", "ci_hi", "runs", "published", "verdict", "reason")
    finite = lambda v: None if isinstance(v, float) and abs(v) == float("inf") else v
    return [{"paper": paper, **{f: finite(row.get(f)) for f in fields}} for row in rows]


def main():
    parser = argparse.ArgumentParser(usage="papers.py [--paper NNN...] [--runs N] [--seed N] [--only WORD...]")
    parser.add_argument("--paper", nargs="+", default=[], choices=list(PAPERS))
    parser.add_argument("--runs", type=int, default=PAGE_RUNS)
    parser.add_argument("--seed", type=int, default=PAGE_SEED)
    parser.add_argument("--only", nargs="+", default=[])
    options = parser.parse_args()
    whole = not options.only and options.runs >= PAGE_RUNS and options.seed == PAGE_SEED
    began, failures, collected = time.monotonic(), [], []
    try:
        sources = page_sources.hash_now(DOCUMENT)
        for paper, experiments in chosen_of(options.only, options.paper).items():
            expected = read_expected(PAPERS[paper][1])
            rows = run_all(experiments, options)
            found = judge(rows, expected, bool(options.only), FULL_RUNS[paper], WANTED[paper])
            failures += [f"paper {paper}: {text}" for text in found]
            collected += as_json(paper, rows)
            if whole:
                write_page(paper, rows, options)
        if whole:
            held = json.loads(JSON.read_text(encoding="utf-8")) if options.paper and JSON.exists() else []
            kept = [row for row in held if row["paper"] not in options.paper]
            JSON.write_text(json.dumps(sorted(kept + collected, key=lambda row: row["paper"]), indent=0) + "\n", encoding="utf-8")
            if not options.paper:
                page_sources.write_hash(DOCUMENT, sources)
    except (Fault, page.Fault, OSError, subprocess.TimeoutExpired) as error:
        print(f"papers: {error}", file=sys.stderr)
        return 2
    for text in failures:
        print(text)
    judged = sum(1 for row in collected if row["verdict"])
    where = f", in {JSON} and docs/papers.md" if whole else "; page left alone"
    print(f"papers: {len(collected)} numbers ({judged} beside the paper's){where}; {options.runs} runs, seed {options.seed}, "
          f"{time.monotonic() - began:.0f} s; {len(failures)} outside their band")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
