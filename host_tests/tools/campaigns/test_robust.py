"""make robust: scores counted by hand, the vibration of its table, and the program that filters a stream."""
import pathlib
import random
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import PLAIN, ROBUST  # noqa: E402
try:
    import numpy as np
    import make_streams
    import robust_runs
    import results
except ImportError as missing:
    sys.exit(f"test_robust: {missing.name} is missing: run it by `make test`")

from system_support import refused, run, run_all, test

OUT = pathlib.Path("build/robust")
REPLAY, STREAM = robust_runs.REPLAY, "sim/streams/steps.csv"


# --- scores -----------------------------------------------------------------------------------------------------------


def made_up(truth_cdeg, angles_cdeg, flags):
    """A stream and a run of it; the readings do not matter."""
    truth, rows = np.array(truth_cdeg), len(truth_cdeg)
    stream = robust_runs.Stream("made-up", None, 1000, np.arange(rows) / 100.0, np.zeros((rows, 3), int), truth)
    return stream, robust_runs.Run(np.array(angles_cdeg), np.round(robust_runs.true_mg(stream)) + [3, 0, -4], np.array(flags))


@test
def scores_are_those_of_a_run_counted_by_hand():
    # warm-up (not scored), then roll off by 3 and 4 degrees across the seam, gated once, re-acquired once
    score = robust_runs.scores(*made_up([(0, 0), (17900, 0), (-17900, 0)], [(9000, 0), (-17800, 100), (17700, -100)], [128 + 1, 1, 4]))
    assert abs(score["roll"] - 12.5 ** 0.5) < 1e-9 and abs(score["pitch"] - 1.0) < 1e-9, score
    assert score["gated"] == 50.0 and score["reacquired"] == 1, score
    assert abs(score["x"] - 3.0) < 0.6 and abs(score["z"] - 4.0) < 0.6, score  # mg rounded to whole ones
    # roll is not scored beyond 80 degrees of pitch, pitch is
    score = robust_runs.scores(*made_up([(0, 0), (0, 8001)], [(200, 0), (9000, 8001)], [0, 0]))
    assert score["roll"] == 2.0 and score["pitch"] == 0.0, score


@test
def the_raw_readings_keep_the_noise_of_their_stream():
    """4 LSB on each axis at 1 g: one axis moves pitch by 4 / 265 radians, rounding to whole LSB adds 1/12; 4 sigma of 6000 rows are 3.7 %."""
    expected = np.degrees(np.sqrt(16.0 + 1.0 / 12.0) / 265.0)
    stream = next(stream for stream in robust_runs.shipped() if stream.name == "rest-4lsb")
    measured = robust_runs.scores(stream, robust_runs.unfiltered(stream, np.zeros(len(stream.lsb), int)))["pitch"]
    assert abs(measured / expected - 1.0) < 0.037, (measured, expected)


# --- the same vibration at two rates ----------------------------------------------------------------------------------


def force_of_shaking(frequency_hz, rate_hz):
    scenario = make_streams.Scenario("x", "x", "x", 1, 3.0, (0.0,) * 3, lambda t: (0.0, 0.0), rate_hz=rate_hz)
    samples = make_streams.make_samples(scenario, random.Random(1))
    robust_runs.shake(samples, frequency_hz)
    return np.array([sample.force_g for sample in samples])


@test
def both_rates_feel_the_same_vibration():
    for frequency_hz in robust_runs.SHAKE_HZ:
        slow, fast = force_of_shaking(frequency_hz, 100), force_of_shaking(frequency_hz, 400)
        assert np.allclose(slow, fast[::4], atol=1e-9)
        felt = fast[400:800] - fast[0]
        size_g = np.linalg.norm(felt, axis=1)
        assert np.all(fast[:400] == fast[0]) and 0.004 < size_g.max() < 0.39063, (frequency_hz, size_g.max())
        # 100 Hz taken every 10 ms is a constant; at 400 Hz it is none, and its mean is 0
        if frequency_hz == 100:
            assert np.ptp(slow[100:200], axis=0).max() < 1e-6 and np.ptp(felt, axis=0).max() > 0.31
            assert np.abs(np.mean(felt, axis=0)).max() < 1e-6


# --- the replay -------------------------------------------------------------------------------------------------------


def replayed(*arguments, expect=0):
    return run(REPLAY, *arguments, expect=expect)


@test
def a_parameter_changes_what_it_names_and_the_shipped_value_nothing():
    shipped = replayed(STREAM, ROBUST, 1000, 16, 0).stdout
    assert replayed(STREAM, ROBUST, 1000, 16, 0, "gate=3", "reacquire=5", "q=10000", "R=1").stdout == shipped
    for change in ("gate=2", "reacquire=9", "q=1000", "R=4"):
        assert replayed(STREAM, ROBUST, 1000, 16, 0, change).stdout != shipped, change


def is_named(words, *arguments):
    """One sentence with these words, and no row before it."""
    done = replayed(*arguments, expect=2)
    assert words in done.stderr and len(done.stderr.splitlines()) == 1 and done.stdout == "", (arguments, done.stderr)


@test
def a_bad_stream_or_argument_is_named():
    bad = OUT / "bad.csv"
    OUT.mkdir(parents=True, exist_ok=True)
    good = "t_us,x_lsb,y_lsb,z_lsb\n0,1,2,3\n"
    for text, words in ((good + "10000,1,two,3\n", "bad.csv:3: y is not a whole number: 'two'"),
                        (good + "10000,1,2,5000\n", "bad.csv:3: z is outside"),
                        (good + "10000,1,2\n", "bad.csv:3: 3 fields"), ("t_us\n", "missing column x"), ("0,1,2,3\n", "header"),
                        (good + "20000,1,2,3\n", "its rows come at 50.0 Hz, which is not within 5 % of 100.0 Hz"), ("", "empty"),
                        (None, "cannot open")):
        bad.unlink(missing_ok=True)
        if text is not None:
            bad.write_text(text, encoding="ascii")
        is_named(words, bad, ROBUST, 1000, 16, 0)
    for arguments, words in (((STREAM, "nothing", 1000, 16, 0), "no filter nothing"), ((STREAM, PLAIN, "1e3", 16, 0), "1e3"),
                             ((STREAM, PLAIN, 1001, 16, 0), "1001: 125, 250"), ((STREAM, PLAIN, 375, 16, 0), "375: 125, 250"),
                             ((STREAM, PLAIN, 1000, 3, 0), "3: 2, 4, 8 or 16"), ((STREAM, PLAIN, 1000, 16, 5100), "no row to filter"),
                             ((STREAM, PLAIN, 1000, 16, 0, "gate=3"), f"{PLAIN} has no parameter gate")):
        is_named(words, *arguments)
    for change, words in (("gate=0.5", "refuses its configuration: gate"), ("gate=1x", "NAME=VALUE"), ("R=nan", "R=nan: a factor"),
                          ("R=-1", "R=-1: a factor"), ("R=0", "R=0: a factor"), ("R=inf", "R=inf: a factor"), ("R=1e30", "R=1e+30: a factor"),
                          ("r=4", "the noise estimate sets r: R=FACTOR"), ("reacquire=5.4", "reacquire=5.4: a whole number"),
                          ("reacquire=4", "reacquire: 3, 5, 9 or 0"), ("gate=nan", "gate=nan does not fit")):
        is_named(words, STREAM, ROBUST, 1000, 16, 0, change)
    for name in ("gate", "R"):
        is_named(f"{name} stands twice", STREAM, ROBUST, 1000, 16, 0, f"{name}=3", "q=1000", f"{name}=4")


@test
def columns_are_found_by_name_and_missing_rows_are_gaps():
    rows = [(k * 10000, 10 + k % 3, -5 + k % 2, 250 + k % 5) for k in range(300)]
    plain, named = OUT / "plain.csv", OUT / "named.csv"
    gone = set(range(150, 155)) | {200}
    plain.write_text("t_us,x,y,z\n" + "".join(f"{t},{x},{y},{z}\n" for k, (t, x, y, z) in enumerate(rows) if k not in gone), encoding="ascii")
    # the row of a fault holds what the sensor never said
    there = [f"{2 + 14 * (k % 2)},4000,{t},?,4000,4000\n" if k in gone else f"0,{z},{t},?,{y},{x}\n" for k, (t, x, y, z) in enumerate(rows)]
    named.write_text("flags,z,t_us,note,y,x\n" + "".join(there), encoding="ascii")
    output = replayed(plain, ROBUST, 1000, 16, 0).stdout
    assert replayed(named, ROBUST, 1000, 16, 0).stdout == output
    coasted = [int(row.split(",")[0]) // 10000 for row in output.splitlines() if int(row.rsplit(",", 1)[1]) & 2]
    assert coasted == sorted(gone) and len(output.splitlines()) == 300


@test
def a_cut_stream_is_named_by_its_path():
    short = OUT / "short.csv"
    OUT.mkdir(parents=True, exist_ok=True)
    head = make_streams.HEADER + "\n"
    row = "0,1,2,256,0,0\n"
    for text in ("", head, head + row, head + row + "10000,1,2", head + row + "10000,1,two,256,0,0\n", head + row + row, None):
        short.unlink(missing_ok=True)
        if text is not None:
            short.write_text(text, encoding="ascii")
        refused(results.Fault, lambda: robust_runs.load_stream(short), "short.csv")


if __name__ == "__main__":
    raise SystemExit(run_all())
