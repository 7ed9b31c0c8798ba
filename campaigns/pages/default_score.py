"""From sums of squares to scores per class, and the rule by which a filter becomes the default."""
import math
import random
from collections import defaultdict
from dataclasses import dataclass

from default_streams import BAD_READS, BURSTS, CLASSES, MOTIONS, OUTLIERS
from laws import DEFAULT, PLAIN
from results import Fault

# shown beside the list's, never chosen
NOT_FILTERS = (f"median5_{PLAIN}", "ema", "median3_ema", "median5_ema", "hampel7_ema", "one_euro", "huber", "student_t", "correntropy", "imm3",
               "own_gates", "one_gate", "alone", "eq11", "raw")
CANDIDATE, NONE_PASSES = DEFAULT, "none"
NEAR, MOST = 1.05, 1.25  # times the best: as good as it; the most that a default may have in any class
NOT_JUDGED = "tuning, "  # before the class: what the defaults may be tuned with does not decide
NONE, HEALTHY, WIRING, CONTENTION = "none", "bad reads 1e-5", "bad reads 1e-3", "contention 20 %"
OUTLIER_KINDS = {"outliers 15 %": OUTLIERS, "outliers in runs": BURSTS, "outliers held": BURSTS}  # and the class of each
REFERENCES = ("5 Hz", "2.5 Hz", "10 Hz", "own")    # as host_tests/tools/campaigns/default_filter.c: truth or smoothed, then the own run
DECIDES, OWN = 0, 3
VALUES_MIN = 100    # a cell with fewer values says nothing
LEAST_LSB = 1e-6    # for logarithms
RESAMPLES, RESAMPLE_SEED = 1000, 5


@dataclass
class Sums:
    count: int
    square: tuple

    def __add__(self, other):
        return Sums(self.count + other.count, tuple(a + b for a, b in zip(self.square, other.square)))

    def rmse(self, reference):
        return math.sqrt(self.square[reference] / self.count)


NOTHING = Sums(0, (0.0,) * len(REFERENCES))


@dataclass
class Cell:
    """What the filters made of one stream at one rate with one kind of fault."""

    group: str      # the class
    name: str       # of the stream
    rate_hz: int
    made: bool      # shipped or made, not recorded
    motion: str     # class of the motion
    sums: dict      # {filter: Sums}
    fault: str = NONE

    def rmse(self, name, reference=DECIDES):
        return self.sums[name].rmse(reference)


def read_rows(text):
    """{(key, rate): {fault: {seed: {filter: (whole, after a bad read)}}}} of what host_tests/tools/campaigns/default_filter.c prints."""
    found = defaultdict(lambda: defaultdict(lambda: defaultdict(dict)))
    width = 1 + len(REFERENCES)
    for line in text.splitlines():
        field = line.split(",")
        if len(field) != 5 + 2 * width:
            raise Fault(f"default_filter: a row with {len(field)} fields: {line}")
        key, rate_dhz, fault, seed, name = field[:5]
        parts = [field[5 + i * width:5 + (i + 1) * width] for i in range(2)]
        found[key, int(rate_dhz) // 10][fault][int(seed)][name] = tuple(Sums(int(p[0]), tuple(map(float, p[1:]))) for p in parts)
    return found


def pooled(runs, fault, seeds, part):
    """{filter: Sums} over the seeds; a seed that put no fault in is the run without faults."""
    total = defaultdict(lambda: NOTHING)
    for seed in range(1, seeds + 1):
        for name, sums in (runs[fault].get(seed) or runs[NONE][0]).items():
            total[name] = total[name] + sums[part]
    return dict(total)


def cells_of_job(job, runs, whole_bad_reads):
    """[(class, fault, {filter: Sums})]"""
    if job.source.motion not in MOTIONS:
        return [(job.source.motion, NONE, {name: sums[0] for name, sums in runs[NONE][0].items()})]
    return [(job.source.motion, HEALTHY, pooled(runs, HEALTHY, job.seeds(), 0)),
            (BAD_READS, WIRING, pooled(runs, WIRING, job.seeds(), 0 if whole_bad_reads else 1)),
            (CONTENTION, CONTENTION, pooled(runs, CONTENTION, job.seeds(), 0)),
            *((group, fault, pooled(runs, fault, job.outlier_seeds(), 0)) for fault, group in OUTLIER_KINDS.items())]


def cells_of(jobs, rows, whole_bad_reads=False):
    """A cell per stream and rate in the class of its motion, and one more for each fault."""
    cells = []
    for job in jobs:
        label = f"{job.source.name} from {job.source.from_s:g} s" if job.source.from_s else job.source.name
        mark = NOT_JUDGED if job.source.tuning else ""
        cells += [Cell(mark + group, label, job.rate_hz, not job.recorded, job.source.motion, sums, fault)
                  for group, fault, sums in cells_of_job(job, rows[job.key(), job.rate_hz], whole_bad_reads)
                  if min(s.count for s in sums.values()) >= VALUES_MIN]
    return cells


# --- scores -----------------------------------------------------------------------------------------------------------


def mean(values):
    values = list(values)
    return sum(values) / len(values)


def geometric_mean(values):
    return math.exp(mean(math.log(value) for value in values))


def log_score(cells, name, reference=DECIDES):
    """Mean over the rates of the mean over their streams of ln(RMSE): no stream and no rate outweighs the others."""
    rates = defaultdict(list)
    for cell in cells:
        rates[cell.rate_hz].append(math.log(max(cell.rmse(name, reference), LEAST_LSB)))
    return mean(mean(values) for values in rates.values())


def geometric(cells, name, reference=DECIDES):
    return math.exp(log_score(cells, name, reference))


def pooled_rms(cells, name, reference=DECIDES):
    """Root of the mean square over all values: the worst streams alone count."""
    return math.sqrt(sum(cell.sums[name].square[reference] for cell in cells) / sum(cell.sums[name].count for cell in cells))


def by_class(cells, names, score=geometric, reference=DECIDES):
    """{class: {filter: score in LSB}} of the classes that have a cell."""
    groups = {group: [cell for cell in cells if cell.group == group] for group in CLASSES}
    return {group: {name: score(part, name, reference) for name in names} for group, part in groups.items() if part}


def redrawn(cells, names):
    """RESAMPLES times the scores by class, each with as many streams as there are, drawn anew with all their rates."""
    groups = {group: defaultdict(list) for group in CLASSES}
    for cell in cells:
        if cell.group in groups:
            groups[cell.group][cell.name].append((cell.rate_hz, [math.log(max(cell.rmse(name), LEAST_LSB)) for name in names]))
    streams = {group: list(found.values()) for group, found in groups.items() if found}
    rng = random.Random(RESAMPLE_SEED)
    return [{group: one_draw(rng.choices(found, k=len(found)), names) for group, found in streams.items()} for _ in range(RESAMPLES)]


def one_draw(chosen, names):
    rates = defaultdict(list)
    for stream in chosen:
        for rate_hz, logs in stream:
            rates[rate_hz].append(logs)
    means = [[mean(column) for column in zip(*values)] for values in rates.values()]
    return {name: math.exp(mean(column)) for name, column in zip(names, zip(*means))}


def ratio_interval(draws, group, name, rival):
    """95 % interval of score(name) / score(rival) of a class over the draws."""
    ratios = sorted(draw[group][name] / draw[group][rival] for draw in draws)
    return ratios[round(0.025 * len(ratios))], ratios[round(0.975 * len(ratios)) - 1]


# --- the rule ---------------------------------------------------------------------------------------------------------


@dataclass
class Verdict:
    default: str
    mean: dict      # {filter: geometric mean over the classes, LSB}
    ratio: dict     # {class: candidate / best}
    beyond: list    # classes in which the candidate is more than MOST times the best
    best_in: list   # classes in which it is best
    why: str


def compared(scores):
    """Filters of the list that have a score in every class."""
    every = set.intersection(*(set(found) for found in scores.values()))
    return [name for name in next(iter(scores.values())) if name in every and name not in NOT_FILTERS]


def verdict(scores, candidate=CANDIDATE, classes=CLASSES):
    """The rule: of the filters that are at most MOST times the best in every class, the one with the least geometric mean over the classes.

    scores: {class: {filter: LSB}}; a class without a stream, or no filter within that, chooses none. What is told is told of the candidate.
    """
    missing = [group for group in classes if group not in scores]
    if missing:
        return Verdict(NONE_PASSES, {}, {}, missing, [], f"no stream of class {', '.join(missing)}")
    names = compared(scores)
    if candidate not in names:
        return Verdict(NONE_PASSES, {}, {}, list(classes), [], f"{candidate} is not in the filter list")
    best = {group: min(scores[group][name] for name in names) for group in classes}
    beyond = {name: [group for group in classes if scores[group][name] > MOST * best[group]] for name in names}
    means = {name: geometric_mean(scores[group][name] for group in classes) for name in names}
    passing = sorted((name for name in names if not beyond[name]), key=means.get)
    ratio = {group: scores[group][candidate] / best[group] for group in classes}
    if beyond[candidate]:
        why = f"more than {MOST:g} times the best in " + ", ".join(f"{group} ({ratio[group]:.2f} times)" for group in beyond[candidate])
    else:
        rival = min((name for name in names if name != candidate), key=means.get, default=candidate)
        why = (f"within {MOST:g} times the best in every class, and its geometric mean over them is {means[candidate]:.3g} LSB "
               f"(`{rival}` {means[rival] / means[candidate]:.2f} times that)")
    return Verdict(passing[0] if passing else NONE_PASSES, means, ratio, beyond[candidate], [group for group in classes if ratio[group] <= 1.0], why)


def other_wins(cells, names):
    """[(class, rate, best filter, candidate / best)] where another filter than the candidate is best."""
    found = []
    for group in CLASSES:
        for rate_hz in sorted({cell.rate_hz for cell in cells if cell.group == group}):
            part = [cell for cell in cells if cell.group == group and cell.rate_hz == rate_hz]
            scores = {name: geometric(part, name) for name in names}
            winner = min(scores, key=scores.get)
            if winner != CANDIDATE:
                found.append((group, rate_hz, winner, scores[CANDIDATE] / scores[winner]))
    return found
