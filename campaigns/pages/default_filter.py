"""make default: which filter should be the default, decided by a table; writes build/default.json (every number) and docs/results/default-filter.md.
Status 1: a number of the committed page does not come out again, each is named. Without the recordings it judges the shipped streams alone,
says so, and leaves the page as it is."""
import dataclasses
import json
import pathlib
import sys
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import default_score as score
import default_streams as streams
from default_score import CANDIDATE, CONTENTION, NOT_JUDGED, OWN
from default_streams import BAD_READS, BURSTS, CLASSES, MOTIONS, OUTLIERS, RATES_HZ
from results import FOLDER, Results, output_of, run_as_program, table

PROGRAM = "build/host/default_filter"
JSON = pathlib.Path("build/default.json")
ABOUT = """
Every filter over the shipped streams and over parts of real recordings ([recordings](../recordings.md)), with bad reads and outliers put in, at 25 to
800 Hz; from this the default filter is chosen. [Choosing a filter](../choosing-a-filter.md) has what follows from it.

""" + pathlib.Path(__file__).with_name("default_about.md").read_text(encoding="utf-8")
PAGE = Results(FOLDER / "default-filter.md", "The default filter: results", "make default", ABOUT)
WORST_LISTED = 2
READINGS = "The same rule, read otherwise"


# --- the run ----------------------------------------------------------------------------------------------------------


def told(message):
    print(f"\rdefault: {message:<50}", end="", file=sys.stderr, flush=True)


def run_jobs(jobs):
    """What the program prints for some jobs."""
    return output_of([PROGRAM], "".join(job.line() + "\n" for job in jobs))


def run_all(jobs):
    """Longest first, a few at a time, so that both processors end together."""
    jobs = sorted(jobs, key=lambda job: -job.rows * (1 + job.seeds()))
    parts = [jobs[i:i + 4] for i in range(0, len(jobs), 4)]
    texts = []
    with ThreadPoolExecutor(2) as pool:
        for text in pool.map(run_jobs, parts):
            texts.append(text)
            told(f"{sum(len(part) for part in parts[:len(texts)])} of {len(jobs)} runs")
    return score.read_rows("".join(texts))


def make_streams():
    wanted = sorted(streams.to_make(), key=lambda item: -item[1])
    with ProcessPoolExecutor(2) as pool:
        for number, _ in enumerate(pool.map(streams.make, *zip(*wanted)), 1):
            told(f"{number} of {len(wanted)} streams made")


def measure():
    """(jobs, rows, True when the recordings are among them)"""
    index = streams.recordings_index()
    make_streams()
    jobs = streams.scenario_jobs() + (streams.recording_jobs(index) if index is not None else [])
    rows = run_all(jobs)
    print(file=sys.stderr)
    return jobs, rows, index is not None


# --- tables -----------------------------------------------------------------------------------------------------------


class Tables:
    """Everything that is made of one run."""

    def __init__(self, jobs, rows):
        self.jobs = jobs
        self.cells = score.cells_of(jobs, rows)
        self.whole = score.cells_of(jobs, rows, whole_bad_reads=True)
        self.tuning = [dataclasses.replace(cell, group=cell.group.removeprefix(NOT_JUDGED)) for cell in self.cells
                       if cell.group.startswith(NOT_JUDGED)]
        self.names = list(self.cells[0].sums)
        self.classes = score.by_class(self.cells, self.names)
        self.compared = score.compared(self.classes)
        self.verdict = score.verdict(self.classes)
        self.draws = score.redrawn(self.cells, self.compared)

    def group(self, group, rate_hz=None):
        return [cell for cell in self.cells if cell.group == group and rate_hz in (None, cell.rate_hz)]

    def best(self, group):
        return min(self.compared, key=lambda name: self.classes[group][name])

    def order(self):
        """The filters by their mean, then what is none of ours."""
        return sorted(self.compared, key=self.verdict.mean.get) + [name for name in score.NOT_FILTERS if name in self.names]


def lsb(value):
    return f"{value:.3g}"


def ratio_text(value):
    return f"{value:.3f}"


def ticks(names):
    return [f"`{name}`" for name in names]


def filter_lines(t, scores):
    """A line for each filter: its geometric mean over the classes, then of each class the RMSE and, in brackets, times the best of ours."""
    best = {group: min(found[name] for name in t.compared) for group, found in scores.items()}
    return {name: [f"`{name}`", lsb(score.geometric_mean(found[name] for found in scores.values())),
                   *(f"{lsb(found[name])} ({found[name] / best[group]:.2f})" for group, found in scores.items())] for name in t.order()}


def class_table(t):
    lines = []
    for name, line in filter_lines(t, t.classes).items():
        passes = "" if name not in t.compared else "no" if score.verdict(t.classes, candidate=name).beyond else "yes"
        lines.append([*line, passes])
    return table("RMSE by class", "LSB (256 per g), geometric mean over the rates of the geometric mean over their streams; in brackets, times "
                 "the best filter of the list. Below it, never chosen: what is beside the list, and the raw samples.",
                 ["filter", "mean", *t.classes, "passes"], lines)


def tuning_table(t):
    scores = score.by_class(t.tuning, t.names)
    return table("Tuning recordings", "As above, of the recordings with which defaults may be tuned; they do not decide.",
                 ["filter", "mean", *scores], list(filter_lines(t, scores).values()))


def contention_table(t):
    cells = {motion: [cell for cell in t.group(CONTENTION) if cell.motion == motion] for motion in MOTIONS}
    scores = {motion: {name: score.geometric(part, name) for name in t.names} for motion, part in cells.items() if part}
    return table("Contention", "Two sensors at one address: 20 % of the reads doubled in runs of up to nine. As above, does not decide.",
                 ["filter", "mean", *scores], list(filter_lines(t, scores).values()))


def rate_table(t):
    order = t.order()
    lines = []
    for group in t.classes:
        for rate_hz in RATES_HZ:
            cells = t.group(group, rate_hz)
            if cells:
                lines.append([f"{group}, {rate_hz} Hz", *(lsb(score.geometric(cells, name)) for name in order), str(len(cells))])
    return table("RMSE by class and rate", "LSB, geometric mean over the streams.", ["class, rate", *ticks(order), "streams"], lines)


def best_table(t):
    lines = []
    for group in t.classes:
        cells = []
        for rate_hz in RATES_HZ:
            found = {name: score.geometric(t.group(group, rate_hz), name) for name in t.compared} if t.group(group, rate_hz) else {}
            least = min(found.values(), default=0.0)
            cells.append(" ".join(f"`{name}`" for name in sorted(found, key=found.get) if found[name] <= score.NEAR * least))
        lines.append([group, *cells])
    return table("Which filter when", "The best, then those within 5 % of it.", ["class", *(f"{rate_hz} Hz" for rate_hz in RATES_HZ)], lines)


def wins_table(t):
    wins = score.other_wins(t.cells, t.compared)
    cells = sum(1 for group in t.classes for rate_hz in RATES_HZ if t.group(group, rate_hz))
    lines = [[f"{group}, {rate_hz} Hz", f"`{winner}`", ratio_text(value)] for group, rate_hz, winner, value in wins]
    return table("Where another filter wins", f"{len(wins)} of {cells} classes at a rate, and how far `{CANDIDATE}` is behind there.",
                 ["class, rate", "best", f"`{CANDIDATE}` / best"], lines)


def losses_table(t):
    lost = []
    for cell in t.cells:
        if cell.group in CLASSES:
            best = min(t.compared, key=cell.rmse)
            lost.append((cell.rmse(CANDIDATE) / cell.rmse(best), cell, best))
    lost.sort(key=lambda item: -item[0])
    worst = [item for group in CLASSES for item in [item for item in lost if item[1].group == group][:WORST_LISTED]]
    lines = [[f"{cell.name}, {cell.rate_hz} Hz", f"{cell.group}, {cell.fault}" if cell.group == BURSTS else cell.group, f"`{best}`",
              lsb(cell.rmse(best)), lsb(cell.rmse(CANDIDATE)), f"{value:.2f}"] for value, cell, best in worst]
    return table(f"Where `{CANDIDATE}` loses most", f"The worst {WORST_LISTED} cells of each class.",
                 ["stream, rate", "class", "best", "its RMSE", f"`{CANDIDATE}`", "ratio"], lines)


def readings(t):
    """(what, {class: {filter: score}}) of every reading of the rule, the deciding one first."""
    with_contention = {**t.classes}
    cells = [cell for cell in t.cells if cell.group in (BAD_READS, CONTENTION)]
    with_contention[BAD_READS] = {name: score.geometric(cells, name) for name in t.names}
    made = [cell for cell in t.cells if cell.made]
    real = [cell for cell in t.cells if not cell.made and not cell.group.startswith(NOT_JUDGED)]
    calm = {group: found for group, found in t.classes.items() if group not in (OUTLIERS, BURSTS)}
    return [("as decided", t.classes),
            ("recordings smoothed at 2.5 Hz", score.by_class(t.cells, t.names, reference=1)),
            ("recordings smoothed at 10 Hz", score.by_class(t.cells, t.names, reference=2)),
            ("against the filter's own run without faults", score.by_class(t.cells, t.names, score.pooled_rms, OWN)),
            ("mean squares pooled: the worst streams count", score.by_class(t.cells, t.names, score.pooled_rms)),
            ("bad reads judged over the whole stream", score.by_class(t.whole, t.names)),
            ("contention among the bad reads", with_contention),
            ("without outliers and bursts", calm),
            ("judged recordings alone", score.by_class(real, t.names)),
            ("shipped and made streams alone", score.by_class(made, t.names)),
            ("tuning recordings in place of the judged ones", score.by_class(made + t.tuning, t.names)),
            ("tuning recordings alone", score.by_class(t.tuning, t.names))]


def readings_table(t):
    lines = []
    for what, scores in readings(t):
        found = score.verdict(scores, classes=tuple(scores))
        lines.append([what, *(f"{found.ratio[group]:.2f}" if group in found.ratio else "" for group in CLASSES), str(len(found.best_in)),
                      f"`{found.default}`"])
    return table(READINGS, f"`{CANDIDATE}` over the best, class by class; only the first line decides. The low pass of 5 Hz is a convention; against "
                 "its own run a filter that stands still would score 0.",
                 ["reading", *CLASSES, "best in", "default"], lines)


def streams_table(t):
    found = {}
    for job in t.jobs:
        found.setdefault((job.source.motion, job.key()), []).append(job)
    lines = []
    for group in CLASSES:
        for (motion, _), jobs in sorted(found.items(), key=lambda item: item[1][0].source.tuning):
            if motion == group:
                source, rates = jobs[0].source, sorted(job.rate_hz for job in jobs)
                part = f", {source.from_s:g}..{source.to_s:g} s" if source.from_s or source.to_s < streams.LONGEST_S else ""
                mark = NOT_JUDGED if source.tuning else ""
                lines.append([source.name + part, mark + group, source.why, " ".join(map(str, rates)), "recorded" if jobs[0].recorded else "made",
                              f"{max(job.rows for job in jobs):,}", f"{min(job.seeds() for job in jobs)}..{max(job.seeds() for job in jobs)}"])
    left = "; ".join(f"{name} ({why})" for name, why in streams.LEFT_OUT.items())
    return table("Which stream is in which class", f"Rates in Hz; rows at the highest of them; seeds of the faults put in. Left out: {left}.",
                 ["stream", "class", "why", "rates", "from", "rows", "seeds"], lines)


def verdict_line(t, group):
    v, best, cells = t.verdict, t.best(group), t.group(group)
    counts = [str(len({cell.name for cell in cells})), str(len(cells))]
    if group not in v.ratio:
        return [group, f"`{best}`", "", "", *counts]
    low, high = score.ratio_interval(t.draws, group, CANDIDATE, best)
    interval = "" if best == CANDIDATE else f" ({low:.2f}..{high:.2f})"
    return [group, f"`{best}`", ratio_text(v.ratio[group]) + interval, "no" if group in v.beyond else "yes", *counts]


def verdict_table(t):
    v = t.verdict
    agree = sum(score.verdict(draw).default == v.default for draw in t.draws)
    said = f"The rule chooses **`{v.default}`**: " + (f"`{CANDIDATE}` is {v.why}." if v.ratio else f"{v.why}.")
    return table("Verdict", f"{said} With the streams drawn again the rule says the same in {agree} of {len(t.draws)} draws; in brackets the "
                 "95 % interval over them. A cell is a stream at a rate with a kind of fault.",
                 ["class", "best", f"`{CANDIDATE}` / best", f"within {score.MOST:g} times", "streams", "cells"],
                 [verdict_line(t, group) for group in t.classes])


def tables(t):
    lines = []
    for part in (verdict_table, class_table, best_table, wins_table, losses_table, readings_table, tuning_table, contention_table, rate_table,
                 streams_table):
        lines += part(t)
    return lines


# --- page and rows ----------------------------------------------------------------------------------------------------


def json_rows(t, real):
    """Flat: the verdict, the classes, and every stream at every rate."""
    v = t.verdict
    rows = [{"level": "verdict", "default": v.default, "candidate": CANDIDATE, "why": v.why, "recordings": real, "beyond": v.beyond,
             "best_in": v.best_in}]
    for group, filters in t.classes.items():
        best = t.classes[group][t.best(group)]
        rows += [{"level": "class", "class": group, "filter": name, "rmse_lsb": value, "times_best": value / best} for name, value in filters.items()]
    for cell in t.cells:
        rows += [{"level": "stream", "class": cell.group, "stream": cell.name, "rate_hz": cell.rate_hz, "made": cell.made, "filter": name,
                  "values": sums.count,
                  **{f"rmse_lsb_{reference}".replace(" ", ""): sums.rmse(i) for i, reference in enumerate(score.REFERENCES)}}
                 for name, sums in cell.sums.items()]
    return rows


def main():
    jobs, rows, real = measure()
    t = Tables(jobs, rows)
    JSON.write_text(json.dumps(json_rows(t, real), indent=0) + "\n", encoding="ascii")
    print(f"default: {len(jobs)} streams at a rate, {len(t.names)} filters; {JSON} written")
    print(f"default: the rule says {t.verdict.default}: {t.verdict.why}")
    if not real:
        print(f"skipped: 1 (no recordings in {streams.recordings_folder()}: shipped streams only, {PAGE.document} left as it is)")
        return 0
    return PAGE.publish(tables(t))


if __name__ == "__main__":
    run_as_program("default", main)
