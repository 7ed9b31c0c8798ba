"""What make default is run on: which stream belongs to which class, at which rates, and where its truth comes from."""
import csv
import dataclasses
import math
import os
import pathlib
from dataclasses import dataclass

import make_streams
from results import Fault

RATES_HZ = (25, 50, 100, 200, 400, 800)
FINE_HZ = 800              # streams that the sensor's own low pass would touch are made at this rate and averaged down
MADE = pathlib.Path("build/default")
SHIPPED = pathlib.Path("sim/streams")
MOTIONS = ("rest", "slow tilt", "handling", "walking", "vibration")
BAD_READS, OUTLIERS, BURSTS = "bad reads", "outliers", "bursts"
CLASSES = (*MOTIONS, BAD_READS, OUTLIERS, BURSTS)
SHORTEST_S = 3.0           # the first second is not counted
LONGEST_S = 180.0
SEED_ROWS, SEEDS_MIN, SEEDS_MAX = 120_000, 4, 40  # so many rows with faults in all, by as many seeds as that takes
OUTLIER_ROWS = 24_000      # likewise with outliers, of which each row has more


@dataclass
class Source:
    """A stream, or a part of one, with the rates at which it is honest."""

    name: str
    motion: str            # of CLASSES; of another than MOTIONS: a stream that has its faults in it
    why: str
    from_s: float = 0.0
    to_s: float = LONGEST_S
    rate_hz: int = 0       # recordings: of the sensor, 0: as the index says
    divide: bool = True    # False: polled, printed or clipped, so that a mean of rows is not what a slower sensor gives
    per_reading: bool = False  # scenarios: noise, faults or times belong to the readings, so each rate is made by itself

    @property
    def tuning(self):
        return self.name in TUNING


# Scenarios of tools/make_streams.py.
SCENARIOS = (
    *(Source(f"rest-{lsb}lsb", "rest", "lies still") for lsb in ("0.7", "2", "4", "8")),
    Source("tilt-slow", "slow tilt", "9 degrees/s at most"),
    Source("through-pitch-90", "slow tilt", "28 degrees/s at most"),
    Source("gaps-jitter", "slow tilt", "as tilt-slow, times off by a tenth of a period, 30 ms to 1 s missing", per_reading=True),
    Source("tilt-fast", "handling", "77 degrees/s at most"),
    Source("tilt-400hz", "handling", "as tilt-fast, as shipped only", divide=False),
    Source("through-roll-180", "handling", "85 degrees/s at most, longer holds"),
    Source("steps", "handling", "the tilt jumps by up to 45 degrees"),
    Source("walk-model", "walking", "not shipped: made for the rates that no recording of a walk has"),
    Source("vibration", "vibration", "bursts of 20 to 45 Hz on a slow tilt"),
    Source("clipping", "vibration", "shocks of 20 to 30 g on a slow tilt"),
    Source("bad-reads", BAD_READS, "1 % single bad reads on a slow tilt", per_reading=True),
    Source("outliers-15pct", OUTLIERS, "15 % of the readings with 20 times a noise of 4 LSB, on a slow tilt", per_reading=True))

# Real ones (../shared/streams).
RECORDINGS = (
    Source("gy85-tilt-92hz", "rest", "lies on a desk", 0, 23, divide=False),
    Source("uav-arm-100-a", "rest", "on a powered airframe", 0, 6),
    Source("uav-hover-poll166", "rest", "on a powered airframe, read 1.7 times as fast as it delivers", 0, 10, divide=False),
    Source("printer-400-rest-zdown", "rest", "on a printer's frame"),
    Source("sis-fall-rail", "rest", "a person lies", 11, 15),
    Source("sis-garbled", "rest", "a person lies", 9.5, 15),
    Source("sis-zero-read-a", "rest", "a person stands", 8.5, 12),
    Source("freeimu-orient-a", "rest", "held still, beginning", 0, 17),
    Source("freeimu-orient-a", "rest", "held still, end", 54.9, 80),
    Source("sis-lie-slow", "slow tilt", "a person lies down and sits up slowly"),
    Source("freeimu-orient-a", "slow tilt", "turned by hand through all attitudes", 17, 54.9),
    Source("sis-roll90", "handling", "a person turns by 90 degrees and back"),
    Source("sis-zero-read-a", "handling", "a person bends; from behind its one bad read", 4, 8.5),
    Source("ax3-200-handle", "handling", "turned and put down by hand"),
    Source("ax3-200-handle-b", "handling", "turned and put down by hand"),
    Source("ax3-400-csv", "handling", "turned and put down by hand"),
    Source("gest-100-2g-a", "handling", "digits drawn into the air, clipped at 2 g", divide=False),
    Source("gy85-tilt-92hz", "handling", "turned and shaken by hand", 23, divide=False),
    Source("ax3-100-walk-a", "walking", "walking and what lies between walks"),
    Source("sis-walk", "walking", "slow walk, sensor at the waist"),
    Source("sis-jog", "walking", "jogging, sensor at the waist"),
    Source("sis-fall-rail", "walking", "motion that ends in a fall", 0, 11),
    Source("sis-garbled", "walking", "motion that ends in a fall; from behind its one bad read", 1, 9.5),
    Source("printer-400-print", "vibration", "a printer prints"),
    Source("motor-1600-a", "vibration", "run-up and run-down of a motor"),
    Source("kl3200-pluck-a", "vibration", "a belt is plucked"),
    Source("kl3200-gaps-a", "vibration", "a belt is plucked, with gaps"),
    Source("uav-hover-poll166", "vibration", "a drone takes off, hovers, lands; 10 % clipped", 10, divide=False),
    Source("uav-agg-poll166", "vibration", "a drone flown roughly; 21 % clipped", divide=False),
    Source("uav-arm-100-a", "vibration", "a drone's arm; 47 % clipped", 6, divide=False),
    Source("uav-arm-100-c", "vibration", "a drone's arm; 6 % clipped", divide=False),
    Source("car-drive-28hz", "vibration", "a car in the city, printed at 28 Hz", rate_hz=25, divide=False),
    Source("car-brake", "vibration", "a car brakes, printed at 28 Hz", rate_hz=25, divide=False),
    Source("quake-offset-a", "vibration", "earthquake simulator; 38 % of the rows repeat", divide=False),
    Source("quake-offset-b", "vibration", "earthquake simulator; 33 % of the rows repeat", divide=False))

# Those with which the filters' defaults may be tuned; on the others they are judged. Each half has every motion; no machine and no person is in
# both.
TUNING = frozenset(("freeimu-orient-a", "gy85-tilt-92hz", "ax3-200-handle", "ax3-200-handle-b", "sis-roll90", "sis-walk", "sis-jog",
                    "sis-fall-rail", "kl3200-pluck-a", "kl3200-gaps-a", "uav-hover-poll166", "uav-agg-poll166", "uav-arm-100-a", "uav-arm-100-c"))

# Streams that no class can have, and why.
LEFT_OUT = {"steps-outliers": "steps with the outliers that the class puts in",
            "free-fall": "no accelerometer knows the tilt in a fall", "sideways-0.5g": "no accelerometer tells it from tilt",
            "edison-sitting": "10 Hz", "edison-standing": "10 Hz", "uav-absent-sensor": "no data",
            "uav-buscontention-a": "its faults are its own, there is no run without them", "kl3200-rest-zup": "shorter than 3 s",
            "kl3200-shake-a": "shorter than 3 s"}


@dataclass
class Job:
    """A line for host_tests/tools/campaigns/default_filter.c."""

    source: Source
    rate_hz: int
    path: pathlib.Path
    range_g: int
    divide: int
    truth: bool
    rows: int
    recorded: bool

    def key(self):
        return f"{self.source.motion}:{self.source.name}:{self.source.from_s:g}".replace(" ", "_")

    def seeds(self):
        return min(max(SEED_ROWS // self.rows, SEEDS_MIN), SEEDS_MAX) if self.source.motion in MOTIONS else 0

    def outlier_seeds(self):
        return min(max(OUTLIER_ROWS // self.rows, 1), SEEDS_MAX) if self.source.motion in MOTIONS else 0

    def line(self):
        return (f"{self.key()} {self.path} {10 * self.rate_hz} {self.range_g} {self.divide} {self.source.from_s:g} {self.source.to_s:g} "
                f"{'truth' if self.truth else 'smooth'} {self.seeds()} {self.outlier_seeds()}")


# --- made streams -----------------------------------------------------------------------------------------------------


def walk_forces(samples, _rng):
    """Two steps a second: 0.25 g along gravity with its harmonic, 0.1 g to the sides, and heel strikes that ring at 15 Hz."""
    for sample in samples:
        t = sample.t_us * 1e-6
        since_s = t % 0.5
        strike = 0.6 * math.exp(-since_s / 0.04) * math.sin(2.0 * math.pi * 15.0 * since_s)
        up = 0.25 * math.sin(4.0 * math.pi * t) + 0.12 * math.sin(8.0 * math.pi * t + 1.0) + strike
        aside = 0.1 * math.sin(2.0 * math.pi * t)
        make_streams.add_force(sample, (0.3 * strike + 0.1 * math.sin(4.0 * math.pi * t + 2.0), aside, up), 1.0)


def swaying(t):
    return 8.0 + 4.0 * math.sin(2.0 * math.pi * t), -5.0 + 3.0 * math.sin(4.0 * math.pi * t)


WALK = make_streams.Scenario("walk-model", "two steps a second", "none: compare with the smoothed stream", 21, 40.0, make_streams.noise(2.0),
                             swaying, disturb=walk_forces)
MADE_SCENARIOS = {scenario.name: scenario for scenario in (*make_streams.SCENARIOS, WALK)}


def at_rate(scenario, rate_hz):
    """The scenario at another rate: equal noise density, times off by the same share of the period."""
    factor = math.sqrt(rate_hz / scenario.rate_hz)
    return dataclasses.replace(scenario, rate_hz=rate_hz, noise_lsb=tuple(lsb * factor for lsb in scenario.noise_lsb),
                               jitter_us=scenario.jitter_us * scenario.rate_hz // rate_hz)


def made_path(name, rate_hz):
    return MADE / f"{name}-{rate_hz}hz.csv"


def make(name, rate_hz):
    """Writes a stream; number of rows."""
    MADE.mkdir(parents=True, exist_ok=True)
    text, rows = make_streams.make_stream(at_rate(MADE_SCENARIOS[name], rate_hz))
    made_path(name, rate_hz).write_text(text, encoding="ascii")
    return rows


def to_make():
    """(name, rate) of every stream that is not shipped as it is."""
    wanted = []
    for source in SCENARIOS:
        own_hz = 0 if source.name == WALK.name else MADE_SCENARIOS[source.name].rate_hz
        if source.per_reading:
            wanted += [(source.name, rate_hz) for rate_hz in RATES_HZ if rate_hz != own_hz]
        elif source.divide:
            wanted.append((source.name, FINE_HZ))
    return wanted


def scenario_jobs():
    jobs = []
    for source in SCENARIOS:
        scenario = MADE_SCENARIOS[source.name]
        model = source.name == WALK.name
        for rate_hz in RATES_HZ:
            rows = round(scenario.seconds * rate_hz)
            if rate_hz == scenario.rate_hz and not model:
                path, divide = SHIPPED / f"{source.name}.csv", 1
            elif source.per_reading:
                path, divide = made_path(source.name, rate_hz), 1
            elif source.divide:
                path, divide = made_path(source.name, FINE_HZ), FINE_HZ // rate_hz
            else:
                continue
            jobs.append(Job(source, rate_hz, path, 16, divide, not model, rows, False))
    return jobs


# --- recordings -------------------------------------------------------------------------------------------------------


COLUMNS = ("name", "dur_s", "rate_hz_nominal", "dt_med_us", "range")  # of the index


def recordings_folder():
    return pathlib.Path(os.environ.get("RECORDINGS") or "../shared/streams")


def recordings_index():
    """{name: row of the index and where it lies}; None where there are no recordings."""
    folder, found = recordings_folder(), {}
    if not os.environ.get("RECORDINGS") and not (folder / "open" / "index.csv").is_file():
        return None
    for part in ("open", "test-only"):
        path = folder / part / "index.csv"
        try:
            rows = list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))
        except (OSError, ValueError) as problem:
            raise Fault(f"{path}: cannot be read: {problem}") from problem
        missing = [column for column in COLUMNS if rows and column not in rows[0]]
        if not rows or missing:
            raise Fault(f"{path}: {'no rows' if not rows else 'no column ' + missing[0]}")
        found.update({row["name"]: {**row, "path": folder / part / f"{row['name']}.csv"} for row in rows})
    return found


def range_of(row):
    text = row["range"].removesuffix("g").strip()
    return int(text) if text in ("2", "4", "8", "16") else 16


def recording_jobs(index):
    jobs = []
    for source in RECORDINGS:
        if source.name not in index:
            raise Fault(f"{recordings_folder()}: no recording '{source.name}' in its index")
        row = index[source.name]
        own_hz = source.rate_hz or round(float(row["rate_hz_nominal"]))
        rows_hz = 1e6 / float(row["dt_med_us"])
        seconds = min(source.to_s, float(row["dur_s"])) - source.from_s
        for rate_hz in RATES_HZ:
            if own_hz % rate_hz or (own_hz != rate_hz and not source.divide) or seconds < SHORTEST_S:
                continue
            divide = own_hz // rate_hz
            jobs.append(Job(source, rate_hz, row["path"], range_of(row), divide, False, round(seconds * rows_hz / divide), True))
    return jobs
