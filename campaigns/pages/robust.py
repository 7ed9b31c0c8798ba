"""make robust: every filter over the shipped streams through the firmware's sample path, into docs/results/robust-filters.md and its pictures.
Nothing in a run is left to chance, so the page must equal it to the last digit."""
import pathlib
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from results import FOLDER, Results, run_as_program, table

try:
    import pictures
    import robust_pictures
    import robust_runs
    from robust_runs import AXES, SHAKE_HZ, SHAKE_RATES_HZ, in_parallel, replay, scores, unfiltered
except ImportError as missing:
    sys.exit(f"robust: {missing.name} is missing: run `make robust`, or use a Python that has tools/deps/requirements.txt")

ABOUT = """
Roll, pitch and acceleration that each filter makes of the [shipped streams](../../sim/streams/README.md), with its defaults, through the firmware's
own sample path on the PC (noise estimate, filter, angles). The streams are simulated, so the truth is known. Rows that warm up or predict a missing
sample do not count.

In the pictures grey points are the raw roll, red crosses those of rows in which `sprf` refused a sample of at least one axis; the lower panels show
the error.
"""
PAGE = Results(FOLDER / "robust-filters.md", "Robust filters: results", "make robust", ABOUT)
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


def stream_tables(streams, names, score):
    def made(title, text, cell, chosen=(RAW, *names)):
        rows = [[stream.name, *(cell(score[stream.name, name]) for name in chosen)] for stream in streams]
        return table(title, text, ["stream", *(name if name == RAW else f"`{name}`" for name in chosen)], rows)

    return [*made("Roll", "Root mean square error in degrees, where the true pitch is within 80 degrees (beyond, roll is hardly defined).",
                  lambda s: degrees(s["roll"])),
            *made("Pitch", "Root mean square error in degrees.", lambda s: degrees(s["pitch"])),
            *made("Acceleration x / y / z", "Root mean square error in mg; the truth is gravity at the true attitude.",
                  lambda s: " / ".join(f"{s[axis]:.1f}" for axis in AXES)),
            *made("Gated", "Rows with flag 1 (a sample of at least one axis beyond the gate) in per cent. `kf`, `lrf` and `synth` have no gate.",
                  lambda s: f"{s['gated']:.2f}", names),
            *made("Re-acquired", "Rows with flag 4: an axis restarted.", lambda s: str(s["reacquired"]), names)]


def changes_table(streams):
    chosen = [stream for stream in streams if stream.name in CHANGES_STREAMS]
    jobs = [(stream, name, [change] if change else []) for name, change in CHANGES for stream in chosen]
    found = iter([scores(job[0], run) for job, run in zip(jobs, in_parallel(replay, jobs))])
    rows = []
    for name, change in CHANGES:
        part = [next(found) for _ in chosen]
        rows.append([f"`{name}` {change or 'as shipped'}", *(degrees(s["roll"]) for s in part), f"{part[0]['gated']:.2f}"])
    return table("One parameter changed", "Roll error in degrees rms. `R=4`: four times what the firmware's noise estimate gives; the others in the "
                 "units of the [parameters](../../lib/filters/README.md#parameters). The last column is that of rest-2lsb.",
                 ["filter", *(stream.name for stream in chosen), "gated at rest, %"], rows)


def shake_table(names):
    streams = {(hz, rate): robust_runs.shaken(hz, rate) for hz in SHAKE_HZ for rate in SHAKE_RATES_HZ}
    _, score = run_all(list(streams.values()), names)
    rows = []
    for hz in SHAKE_HZ:
        pairs = [[score[streams[hz, rate].name, name]["roll"] for rate in SHAKE_RATES_HZ] for name in [RAW, *names]]
        rows.append([f"{hz} Hz", *(" / ".join(f"{value:.2f}" for value in pair) for pair in pairs)])
    return table("The same vibration at 100 / 400 Hz", "Roll error in degrees rms at an output data rate of 100 Hz / of 400 Hz. Bursts of 1 s, "
                 "0.39 g in a random direction, on a slow tilt; equal noise density. Samples are taken at an instant: the sensor's own low pass "
                 "(half the rate) is not modelled.", ["vibration", RAW, *(f"`{name}`" for name in names)], rows)


def measure():
    """(lines of the tables, streams, {(stream, filter): run})"""
    names, streams = robust_runs.filters(), robust_runs.shipped()
    runs, score = run_all(streams, names)
    return [*stream_tables(streams, names, score), *changes_table(streams), *shake_table(names)], streams, runs


def main():
    tables, streams, runs = measure()
    shown = robust_pictures.contents(streams, runs)
    return PAGE.publish(pictures.on_page(shown) + tables, shown)


if __name__ == "__main__":
    run_as_program("robust", main)
