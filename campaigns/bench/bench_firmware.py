"""What make bench measures on the firmware itself: a sample's way as a whole (sample_total), without its filters (sample_rest), a row."""
import csv
import json
import pathlib
import statistics

from laws import LIGHT
from results import Fault, output_of as run

SIMRUN = "build/sim/simrun"
OUT = pathlib.Path("build/uno")
COMPILER = "5.4.0"  # the limits are for Debian's avr-gcc; elsewhere the numbers are only reported

# The firmware's own way of a sample: stream, options of simrun
SAMPLE_RUNS = (("outliers-15pct", ()), ("gaps-jitter", ()), ("clipping", ()), ("bad-reads", ()), ("vibration", ()),
               ("tilt-400hz", ("--rate", "400", "--baud", "500000")), ("through-roll-180", ()))
# What a sample costs beside its filters, at the highest rate, and a row: streams and modes whose costs are the highest, seconds in which
# a difference of two runs is taken (the banner and the commands are in both)
REST_STREAMS = ("outliers-15pct", "vibration", "bad-reads")
ROW_RUNS = (("outliers-15pct", "plot"), ("widest", "plot"), ("widest", "csv"))
REST_OPTIONS = ("--loop", "--rate", "800", "--baud", "1000000", "--filter", LIGHT)
ROW_EVERY = 2  # what the lightest filter is sure to leave time for
REST_FROM_MS, REST_TO_MS = 2500, 6500
CPU_HZ = 16000000
# An estimate of R leaves the last by an eighth at most so often: a term counts three times the mean at most, in a window of 256.
NOISE_SAMPLES = 16


def image_size(elf):
    """Flash and RAM bytes."""
    sizes = {w[0]: int(w[1]) for w in (line.split() for line in run(["avr-size", "-A", elf]).splitlines()) if len(w) == 3 and w[1].isdigit()}
    data = sizes.get(".data", 0)
    return sizes.get(".text", 0) + data, data + sizes.get(".bss", 0) + sizes.get(".noinit", 0)


def printed(image):
    """What a program for the chip prints in the simulator; status 8 is how it ends."""
    text = image.with_suffix(".txt")
    run([SIMRUN, "--fw", image, "--in", "sim/streams/tilt-fast.csv", "--out", text, "--max-ms", "300000"], statuses=(8,))
    return text.read_text(encoding="ascii")


def measure_sample():
    """The sample's way in the firmware: cycles and stack of every sample of some streams."""
    cycles, stack, worst = [], 0, (0, "")
    for stream, options in SAMPLE_RUNS:
        spans = OUT / "bench_sample.csv"
        run([SIMRUN, "--fw", OUT / "bench_sample.elf", "--in", f"sim/streams/{stream}.csv", "--out", OUT / "bench_sample.txt", "--span",
             f"bench_sample_begins:bench_sample_ends:{spans}", *options])
        with open(spans, encoding="ascii") as file:
            rows = list(csv.DictReader(file))
        if not rows:
            raise Fault(f"sample_total: no sample of {stream} was timed")
        part = [int(row["cycles"]) for row in rows]
        stack = max(stack, *(int(row["stack_bytes"]) for row in rows))
        worst = max(worst, (max(part), stream))
        cycles.append((stream, part))
    values = [v for _, part in cycles for v in part]
    typical = [v for stream, part in cycles if stream == "outliers-15pct" for v in part]
    return {"min": min(values), "median": round(statistics.median(typical)), "worst": worst[0], "where": worst[1], "samples": len(values)}, stack


def busy(stream, every, mode, ms):
    """Cycles awake, samples and lines of output of the image without filters after so many simulated milliseconds."""
    stats, out = OUT / "bench_rest.json", OUT / "bench_rest.txt"
    run([SIMRUN, "--fw", OUT / "bench_rest.elf", "--in", stream, "--out", out, "--stats", stats, *REST_OPTIONS, "--every", every,
         "--cmd", f"1500:mode {mode}", "--max-ms", ms])
    told = json.loads(stats.read_text(encoding="ascii"))
    return told["cpu_load"] * ms * CPU_HZ / 1000, told["samples_served"], out.read_text(encoding="ascii").count("\n")


def mean_busy(stream, every, mode="csv"):
    """Cycles a sample, without start and commands; every sample must have the row that it is to have."""
    (cycles, samples, lines), (cycles_end, samples_end, lines_end) = (busy(stream, every, mode, ms) for ms in (REST_FROM_MS, REST_TO_MS))
    if every == ROW_EVERY and abs((lines_end - lines) * every - (samples_end - samples)) > 2 * every:
        raise Fault(f"row: {lines_end - lines} rows for {samples_end - samples} samples of {stream.stem} in the image without filters")
    return (cycles_end - cycles) / (samples_end - samples)


def widest_stream():
    """Readings whose columns are as wide as they get, and still not clipped: -4095 and -4094 by turns."""
    path = OUT / "widest.csv"
    lines = [f"{i * 10000},{v},{v},{v}" for i, v in ((i, -4095 + i % 2) for i in range(2000))]
    path.write_text("\n".join(["t_us,x_lsb,y_lsb,z_lsb", *lines, ""]), encoding="ascii")
    return path


def rest_row(means, rows):
    """The rest of a sample's way: the highest mean, and what its three noise estimates and new variances can take beyond it."""
    mean, where = max((mean, where) for where, mean in means.items())
    noise = 3 * (max(rows["noise"]["worst"], rows["noise"]["worst_small"]) - rows["noise"]["median"])
    variances = 3 * max(row["worst"] for name, row in rows.items() if name.endswith("_set_noise")) / NOISE_SAMPLES
    return {"min": round(min(means.values())), "median": round(statistics.median(means.values())), "worst": round(mean + noise + variances),
            "where": where, "samples": 0}


def measure_rest(rows):
    """Rows `sample_rest` and `row` of the table."""
    streams = {name: pathlib.Path(f"sim/streams/{name}.csv") for name in REST_STREAMS}
    without = {name: mean_busy(path, 10000) for name, path in streams.items()}
    streams["widest"] = widest_stream()
    without_widest = {**without, "widest": mean_busy(streams["widest"], 10000)}
    row = {f"{name}, {mode}": ROW_EVERY * (mean_busy(streams[name], ROW_EVERY, mode) - without_widest[name]) for name, mode in ROW_RUNS}
    worst, where = max((cycles, where) for where, cycles in row.items())
    return rest_row(without_widest, rows), {"min": round(min(row.values())), "median": round(statistics.median(row.values())),
                                            "worst": round(worst), "where": where, "samples": 0}
