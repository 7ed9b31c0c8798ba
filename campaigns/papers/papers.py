#!/usr/bin/env python3
"""make papers: runs the experiments of the papers side by side, judges each number against its accepted band and the paper's, writes
build/papers.json, docs/results/papers-NNN.md and the index of claims, docs/results/papers-index.md.

    papers.py [--paper NNN...] [--runs N] [--seed N] [--only WORD...]

--paper: only these papers, the others' pages and their part of the JSON stay. With --only, with fewer runs or with another seed pages and JSON
are left alone; with all runs and another seed a verdict that differs from the page's is a failure.
"""
import argparse
import concurrent.futures
import json
import pathlib
import sys
import time

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import page_sources
import papers_index
from papers_judge import BANDED, VERDICT_RUNS, Fault, judge, name_of, read_expected
from papers_page import document, judged_on, write_page
from results import output_of, run_as_program

# programs and accepted bands of each paper; a folder is a program in Python
PAPERS = {paper: (programs, pathlib.Path(f"host_tests/papers/expected_{paper}.csv"))
          for paper, programs in (("000", ("campaigns/synthesis 000",)), ("001", ("campaigns/synthesis 001",)),
                                  ("002", ("campaigns/resilience", "build/papers/operations002")), ("003", ("build/papers/paper003",)),
                                  ("004", ("campaigns/variable_structure", "build/papers/paper004_board")))}
PYTHON = pathlib.Path("build/venv/bin/python")  # which has numpy
# runs that the programs make of --runs 10000, and what each shipped filter must have a band for
FULL_RUNS = {"000": 4000, "001": 2000, "002": VERDICT_RUNS, "003": 200, "004": 500}
WANTED = {"000": ("mse_2_5",), "001": ("sigma_stationary",), "002": BANDED, "003": (), "004": ()}
JSON = pathlib.Path("build/papers.json")
PAGE_RUNS, PAGE_SEED = 10000, 2024
WORKERS = 2
BAR = 30  # columns


def show_progress(done, work, began):
    """How much of the work is done and the time left, on a terminal only; an empty line where nothing is done."""
    text = ""
    if done:
        filled, left_s = int(BAR * done / work), (time.monotonic() - began) * (work - done) / done
        text = f"papers [{'#' * filled}{'.' * (BAR - filled)}] {100 * done / work:3.0f} %  {left_s:.0f} s left"
    if sys.stderr.isatty():
        print(f"\r\x1b[K{text}", end="", file=sys.stderr, flush=True)


def command_of(program):
    words = program.split()
    if not pathlib.Path(words[0]).is_dir():
        return words
    if not PYTHON.exists():
        raise Fault(f"{program}: needs {PYTHON}, which is not there: sh tools/deps.sh papers")
    return [PYTHON, *words]


def number(text):
    return float(text) if text else None


def run_one(program, experiment, options):
    """Rows (dictionaries) that an experiment prints."""
    rows = []
    for line in output_of([*command_of(program), experiment, "--runs", options.runs, "--seed", options.seed]).splitlines():
        kind, *cells = line.split("\t")
        if kind != "row" or len(cells) not in (8, 9):
            raise Fault(f"{experiment}: cannot read its line '{line}'")
        rows.append(dict(zip(("experiment", "filter", "arithmetic", "metric"), cells),
                         value=float(cells[4]), ci_lo=number(cells[5]), ci_hi=number(cells[6]), runs=int(cells[7]),
                         sample=[float(word) for word in "".join(cells[8:]).split(",") if word]))
    if not rows:
        raise Fault(f"{experiment}: printed no row")
    return rows


def experiments_of(programs):
    """{experiment: (program, work in about seconds)}."""
    lines = [(program, line.split("\t")) for program in programs for line in output_of([*command_of(program), "--list"]).splitlines()]
    return {name: (program, float(work)) for program, (name, work) in lines}


def chosen_of(words, only=()):
    """{paper: {experiment: (program, work)}} of the experiments whose name contains a word, or of all; of all papers or only some."""
    found = {paper: experiments_of(programs) for paper, (programs, _) in PAPERS.items() if not only or paper in only}
    chosen = {paper: {name: entry for name, entry in all_.items() if not words or any(w in name for w in words)} for paper, all_ in found.items()}
    if not any(chosen.values()):
        raise Fault(f"no experiment's name contains {' or '.join(words)}; there are {', '.join(name for all_ in found.values() for name in all_)}")
    return {paper: experiments for paper, experiments in chosen.items() if experiments}


def run_all(chosen, options):
    """{paper: rows of its experiments, in the order of the list} of {paper: {experiment: (program, work)}}; two at a time, longest first."""
    began, done = time.monotonic(), 0.0
    tasks = sorted(((part, program, name, paper) for paper, experiments in chosen.items() for name, (program, part) in experiments.items()),
                   key=lambda task: -task[0])
    work = sum(part for part, *_ in tasks)
    try:
        with concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
            futures = {pool.submit(run_one, program, name, options): (part, paper, name) for part, program, name, paper in tasks}
            for future in concurrent.futures.as_completed(futures):
                done += futures[future][0]
                show_progress(done, work, began)
    finally:
        show_progress(0.0, work, began)
    rows = {(paper, name): future.result() for future, (_, paper, name) in futures.items()}
    return {paper: [row for name in experiments for row in rows[paper, name]] for paper, experiments in chosen.items()}


def as_json(paper, rows):
    """A value that is not finite (never back) is null."""
    fields = ("experiment", "filter", "arithmetic", "metric", "value", "ci_lo", "ci_hi", "share", "runs", "published", "rule", "verdict", "reason")
    finite = lambda v: None if isinstance(v, float) and abs(v) == float("inf") else v
    return [{"paper": paper, **{f: finite(row.get(f)) for f in fields}} for row in rows]


def changed_verdicts(rows, text):
    """Verdicts of a run of another seed that are not the page's."""
    held = {tuple(row[f] for f in ("experiment", "filter", "arithmetic", "number", "printed")): row["verdict"] for row in judged_on(text)}
    for row in (row for row in rows if row.get("verdict")):
        before = held.get((row["experiment"], row["filter"], row["arithmetic"], row["metric"], row["published"]))
        if before != row["verdict"]:
            yield f"{name_of(row)} = {row['value']:.6g} is {row['verdict']} ({row['published']}: {row['rule']}), on the page {before}"


def options_of(words):
    parser = argparse.ArgumentParser(usage="papers.py [--paper NNN...] [--runs N] [--seed N] [--only WORD...]")
    parser.add_argument("--paper", nargs="+", default=[], choices=list(PAPERS))
    parser.add_argument("--runs", type=int, default=PAGE_RUNS)
    parser.add_argument("--seed", type=int, default=PAGE_SEED)
    parser.add_argument("--only", nargs="+", default=[])
    return parser.parse_args(words)


def main():
    options = options_of(sys.argv[1:])
    whole = not options.only and options.runs >= PAGE_RUNS and options.seed == PAGE_SEED
    began, failures, collected = time.monotonic(), [], []
    sources = {paper: page_sources.hash_now(document(paper)) for paper in PAPERS}
    for paper, rows in run_all(chosen_of(options.only, options.paper), options).items():
        expected = read_expected(PAPERS[paper][1])
        found = judge(rows, expected, bool(options.only), FULL_RUNS[paper], WANTED[paper])
        failures += [f"paper {paper}: {text}" for text in found]
        collected += as_json(paper, rows)
        if options.runs >= PAGE_RUNS and not whole:
            failures += [f"paper {paper}: {text}" for text in changed_verdicts(rows, document(paper).read_text(encoding="utf-8"))]
        if whole:
            write_page(paper, rows, options, sources[paper])
    if whole:
        held = json.loads(JSON.read_text(encoding="utf-8")) if options.paper and JSON.exists() else []
        kept = [row for row in held if row["paper"] not in options.paper]
        JSON.write_text(json.dumps(sorted(kept + collected, key=lambda row: row["paper"]), indent=0) + "\n", encoding="utf-8")
        papers_index.write()
    for text in failures:
        print(text)
    judged = sum(1 for row in collected if row["verdict"])
    where = f", in {JSON} and docs/results/papers-*.md" if whole else "; pages left alone"
    print(f"papers: {len(collected)} numbers ({judged} beside the paper's){where}; {options.runs} runs, seed {options.seed}, "
          f"{time.monotonic() - began:.0f} s; {len(failures)} outside their band or with another verdict")
    return 1 if failures else 0


if __name__ == "__main__":
    run_as_program("papers", main)
