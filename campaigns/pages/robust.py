#!/usr/bin/env python3
"""Runs every filter over the shipped streams through the firmware's sample path and writes docs/robust-filters.md's numbers.

    robust.py            writes the tables, the numbers in the text between <!--= ... --> and <!--.-->, and the pictures; a number of the
                         committed page that does not come out again is named and makes the exit status 1
    robust.py --check    compares page and pictures with a new run and writes nothing

Nothing in a run is left to chance, so the page must equal it to the last digit. A picture holds the hash of what it shows.
"""
import argparse
import pathlib
import subprocess
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from page import Page as Text

try:
    import robust_pictures
    import robust_runs
    from robust_runs import AXES, SHAKE_HZ, SHAKE_RATES_HZ, Fault, in_parallel, replay, scores, unfiltered
except ImportError as missing:
    sys.exit(f"robust: {missing.name} is missing: run `make robust`, or use a Python that has tools/deps/requirements.txt")

DOCUMENT = pathlib.Path("docs/robust-filters.md")
BEGIN, END = "<!-- written by make robust: begin -->", "<!-- written by make robust: end -->"
TEXT = Text(DOCUMENT, BEGIN, END)
RAW = "raw"
# what is changed from the shipped values, one at a time; a filter or parameter that is not there is an error, not a gap in the table
CHANGES = (("kf", ""), ("kf", "q=1000"), ("kf", "q=100000"),
           ("sprf", ""), ("sprf", "R=0.0625"), ("sprf", "R=0.25"), ("sprf", "R=0.5"), ("sprf", "R=2"), ("sprf", "R=4"), ("sprf", "R=16"),
           ("sprf", "q=1000"), ("sprf", "q=100000"), ("sprf", "gate=2"), ("sprf", "gate=4"), ("sprf", "gate=6"),
           ("sprf", "reacquire=3"), ("sprf", "reacquire=9"), ("sprf", "reacquire=0"), ("sprf", "ratemax=200"), ("sprf", "ratemax=3200"),
           ("soft", ""), ("soft", "R=0.25"), ("soft", "R=4"), ("soft", "softgate=1.5"), ("soft", "softgate=3"), ("soft", "reacquire=0"),
           ("lrf", ""), ("lrf", "clean=0.99"), ("lrf", "ratio=5"),
           ("pbf", ""), ("pbf", "R=0.25"), ("pbf", "R=4"), ("pbf", "clean=0.99"), ("pbf", "ratio=5"),
           ("sprf_paper", ""), ("sprf_paper", "R=0.25"), ("sprf_paper", "gate=3"))
CHANGES_STREAMS = ("rest-2lsb", "tilt-fast", "outliers-15pct", "vibration", "steps", "steps-outliers")


class Page:
    """The tables in the making, and every number in them by what it is."""

    def __init__(self):
        self.lines, self.values = [], {}

    def table(self, key, title, head, rows, text):
        """rows: [(name, [cell])], the cells under head[1:]; key, row and column together name a number."""
        self.lines += ["", f"### {title}", text, "", "| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
        for name, cells in rows:
            self.lines.append("| " + " | ".join([name, *cells]) + " |")
            for column, cell in zip(head[1:], cells):
                self.values[f"{key} {name} {column}".replace("`", "")] = cell


# --- tables -----------------------------------------------------------------------------------------------------------


def run_all(streams, names):
    """{(stream, filter): scores}, the raw readings among the filters."""
    jobs = [(stream, name) for stream in streams for name in names]
    runs = {(stream.name, name): run for (stream, name), run in zip(jobs, in_parallel(replay, jobs))}
    for stream in streams:
        runs[stream.name, RAW] = unfiltered(stream, runs[stream.name, names[0]].flags)
    return runs, {(stream.name, name): scores(stream, runs[stream.name, name]) for stream in streams for name in [RAW, *names]}


def degrees(value):
    return f"{value:.3f}"


def stream_tables(page, streams, names, score):
    columns = [RAW, *names]
    head = ["stream", *(f"`{name}`" if name != RAW else RAW for name in columns)]

    def rows(cell, chosen):
        return [(stream.name, [cell(score[stream.name, name]) for name in chosen]) for stream in streams]

    page.table("roll", "Roll", head, rows(lambda s: degrees(s["roll"]), columns),
               "Root mean square error in degrees, where the true pitch is within 80 degrees (beyond, roll is hardly defined).")
    page.table("pitch", "Pitch", head, rows(lambda s: degrees(s["pitch"]), columns), "Root mean square error in degrees.")
    page.table("axes", "Acceleration x / y / z", head, rows(lambda s: " / ".join(f"{s[axis]:.1f}" for axis in AXES), columns),
               "Root mean square error in mg; the truth is gravity at the true attitude.")
    head.pop(1)
    page.table("gated", "Gated", head, rows(lambda s: f"{s['gated']:.2f}", names),
               "Rows with flag 1 (a sample of at least one axis beyond the gate) in per cent. `kf`, `lrf` and `synth` have no gate.")
    page.table("reacquired", "Re-acquired", head, rows(lambda s: str(s["reacquired"]), names), "Rows with flag 4: an axis started anew.")


def changes_table(page, streams):
    chosen = [stream for stream in streams if stream.name in CHANGES_STREAMS]
    jobs = [(stream, name, [change] if change else []) for name, change in CHANGES for stream in chosen]
    results = iter([scores(job[0], run) for job, run in zip(jobs, in_parallel(replay, jobs))])
    rows = []
    for name, change in CHANGES:
        part = [next(results) for _ in chosen]
        rows.append((f"`{name}` {change or 'as shipped'}", [*(degrees(s["roll"]) for s in part), f"{part[0]['gated']:.2f}"]))
    page.table("change", "One parameter changed", ["filter", *(stream.name for stream in chosen), "gated at rest, %"], rows,
               "Roll error in degrees rms. `R=4`: four times what the firmware's noise estimate says; the others in the units of the "
               "[parameters](../lib/filters/README.md#parameters). The last column is that of rest-2lsb.")


def shake_table(page, names):
    streams = {(hz, rate): robust_runs.shaken(hz, rate) for hz in SHAKE_HZ for rate in SHAKE_RATES_HZ}
    _, score = run_all(list(streams.values()), names)
    rows = []
    for hz in SHAKE_HZ:
        pairs = [[score[streams[hz, rate].name, name]["roll"] for rate in SHAKE_RATES_HZ] for name in [RAW, *names]]
        rows.append((f"{hz} Hz", [" / ".join(f"{value:.2f}" for value in pair) for pair in pairs]))
    page.table("shake", "The same vibration at 100 / 400 Hz", ["vibration", RAW, *(f"`{name}`" for name in names)], rows,
               "Roll error in degrees rms at an output data rate of 100 Hz / of 400 Hz. Bursts of 1 s, 0.39 g in a random direction, on "
               "a slow tilt; equal noise density. Samples are taken at an instant: what the sensor's own low pass (half the rate) keeps away "
               "is not modelled.")


def measure():
    """(page, [(stream, {filter: run})])"""
    names, streams = robust_runs.filters(), robust_runs.shipped()
    runs, score = run_all(streams, names)
    page = Page()
    stream_tables(page, streams, names, score)
    changes_table(page, streams)
    shake_table(page, names)
    return page, streams, runs


# --- page -------------------------------------------------------------------------------------------------------------


def filled(text, page):
    """The page's text with its tables and numbers put in."""
    return TEXT.filled(text, [*page.lines, ""], page.values)


def check(text, page):
    """What is not as a new run has it."""
    new = filled(text, page)
    faults = TEXT.differences(text, new)
    if not faults and new != text:
        faults = ["its tables differ from those of this run: make robust writes them"]
    return [f"{DOCUMENT}: {fault}" for fault in faults]


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="compare instead of writing")
    options = parser.parse_args(arguments)
    page, streams, runs = measure()
    pictures = robust_pictures.contents(streams, runs)
    text = DOCUMENT.read_text(encoding="utf-8")
    if options.check:
        faults = check(text, page) + robust_pictures.stale(pictures)
    else:
        faults = TEXT.write(text, [*page.lines, ""], page.values)
        drawn = robust_pictures.draw_stale(pictures)
        print(f"robust: {DOCUMENT} written, {drawn} of {len(pictures)} pictures drawn anew")
    for fault in faults:
        print(f"robust: {fault}", file=sys.stderr)
    print(f"robust: {len(page.values)} numbers, {len(faults)} findings")
    return 1 if faults else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Fault, OSError, subprocess.TimeoutExpired) as problem:
        print(f"robust: {problem}", file=sys.stderr)
        sys.exit(2)
