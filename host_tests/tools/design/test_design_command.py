"""The command of tools/design: that the compiled library accepts every configuration it prints and runs as the tool says; its pictures and JSON.
What it refuses: test_design_refusals.py."""
import math
import pathlib
import random
import re
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from design_support import BASE, OUT, Library, answer, compiles_and_runs, simulated
from laws import PLAIN
from system_support import needs, run, run_all, test

needs("design", "matplotlib", "scipy")

import matplotlib.image  # noqa: E402
from design import command, configuration, measure, response, switching  # noqa: E402
from design.structure import Filter  # noqa: E402

LIBRARY = Library()
# each by a parameter that it alone has
ONE_GAIN, TAPS, SCHEDULED, OF_JERK = (LIBRARY.law_with(field) for field in ("a1_q16", "b2_q16", "variant_u", "q_lsb2_s5"))


@test
def a_design_keeps_its_bound_as_stored():
    chance = random.Random(6)
    for _ in range(12):
        rate, sigma = chance.choice((12.5, 25, 50, 100, 200, 400, 800)), round(10 ** chance.uniform(-0.5, 1.2), 2)
        error = 10 ** chance.uniform(-1, 1.6)
        at = round(10 ** chance.uniform(0, 4), 1)
        result, _ = answer("--rate", rate, "--sigma", sigma, "--error", repr(error * at / rate ** 2), "--at", at, "--no-pictures")
        assert result["design"]["dynamic_error"] <= error * (1 + 1e-9)
        for made in result["configurations"]:
            if "none" in made:
                continue
            assert made["dynamic_error"] <= error * (1 + 1e-9), made
            accepted(made)
    result, _ = answer(*BASE, "--noise-gain", "0.61")
    for made in result["configurations"]:
        assert "none" in made or made["noise_gain"] <= 0.61, made


def accepted(made):
    if made["filter"] not in LIBRARY.names:
        return
    ok, _ = LIBRARY.make(made["filter"], made["fields"])
    assert ok, f"the library refuses {made['initialiser']}"


@test
def the_library_and_the_tool_refuse_the_same():
    chance, seen = random.Random(7), [0, 0]
    common = {"rate_dhz": 1000, "r_lsb2_q8": 768}
    cases = [(chance.randint(0, 65535), chance.randint(-65600, 65600)) for _ in range(2000)]
    cases += [(b0, a1 + step) for b0 in range(656, 32700, 197) for a1 in [-(2 ** 31 // (65536 - b0))] for step in (-1, 0, 1)]
    cases += [(655, 0), (656, 0), (65535, 0), (656, 65535), (656, 65536), (656, -65536), (65535, -65535)]
    for b0, a1 in cases:
        wanted = configuration.gain_legal(b0, a1)
        ok, _ = LIBRARY.make(ONE_GAIN, {**common, "b0_uq16": b0, "a1_q16": a1})
        assert ok == wanted, (b0, a1, ok)
        if abs(a1) < 65536 and 656 <= b0:
            assert configuration.gain_filter(b0, a1).stable() == wanted, (b0, a1)
        seen[ok] += 1
    assert min(seen) > 200, seen
    ranges = {"b0_uq16": configuration.B0, "a1_q16": configuration.A1, "r_lsb2_q8": configuration.R_Q8,
              "rate_max_lsb_s": (10, configuration.RATE_MAX_LSB_S)}
    assert LIBRARY.ranges(ONE_GAIN) == ranges, LIBRARY.ranges(ONE_GAIN)
    assert LIBRARY.ranges(PLAIN) == {"r_lsb2_q8": configuration.R_Q8, "q_lsb2_s3": configuration.Q}
    for field, (low, high) in ranges.items():
        for value, wanted in ((low - 1, False), (low, True), (high, True), (high + 1, False)):
            if field != "b0_uq16" or value < 65536:
                ok, _ = LIBRARY.make(ONE_GAIN, {**common, "b0_uq16": 60000, "a1_q16": 0, field: value})
                assert ok == wanted, (field, value)
    for rate in (49, 50, 40000, 40001):
        ok, _ = LIBRARY.make(ONE_GAIN, {"rate_dhz": rate, "b0_uq16": 20000, "a1_q16": 0, "r_lsb2_q8": 768})
        assert ok == (configuration.RATE_DHZ[0] <= rate <= configuration.RATE_DHZ[1]), rate


@test
def library_and_tool_refuse_the_same_taps():
    chance, seen = random.Random(8), [0, 0]
    for _ in range(3000):
        fields = {"rate_dhz": 1000, "r_lsb2_q8": 768, "k": chance.choice((0, 0, 1, 2, 5, 15, 16, 17)), "b0_uq16": chance.randint(600, 65535),
                  "b1_q16": chance.randint(-65600, 65600), "b2_q16": chance.choice((0, chance.randint(-65600, 65600)))}
        wanted = configuration.plus_legal(*(fields[name] for name in ("k", "b0_uq16", "b1_q16", "b2_q16")))
        ok, _ = LIBRARY.make(TAPS, fields)
        assert ok == wanted, (fields, ok)
        seen[ok] += 1
    assert min(seen) > 200, seen
    for arguments in (["-k", "0", "-l", "1"], ["-l", "2", "--a=-0.75"], ["-v", "3", "-k", "0", "-l", "2"]):
        result, _ = answer(*BASE, *arguments, "--noise-gain", "0.4")
        made = result["configurations"][0]
        assert made["filter"] == TAPS and made["noise_gain"] <= 0.4, made
        accepted(made)
        assert compiles_and_runs(made["initialiser"], TAPS)
        stored = [made["fields"][b] for b in ("b0_uq16", "b1_q16", "b2_q16")]
        runs_as_told(TAPS, made["fields"], configuration.plus_filter(made["fields"]["k"], stored))


def runs_as_told(name, fields, f):
    """The compiled filter's answer to a step, after its start has died out, is the tool's filter's."""
    ok, state = LIBRARY.make(name, fields)
    assert ok
    for _ in range(3000):
        LIBRARY.update(state, 0)
    size = 1500
    wanted = simulated(Filter(f.v, tuple(map(float, f.a)), tuple(map(float, f.b))), 60, lambda n: float(size))
    for n, x in enumerate(wanted):
        found = LIBRARY.update(state, size) / 65536
        if abs(x) >= 4600:
            return n
        assert abs(found - x) < 0.05, (name, fields, n, found, x)
    return 60


@test
def the_emitted_configuration_runs_as_told():
    for arguments in (["--noise-gain", "0.6"], ["--a=-0.3", "--b", "0.5"], ["--error", "2", "--at", "30000"]):
        result, _ = answer(*BASE, *arguments)
        made = result["configurations"][0]
        assert made["filter"] == ONE_GAIN and compiles_and_runs(made["initialiser"], ONE_GAIN), made
        stored = configuration.gain_filter(made["fields"]["b0_uq16"], made["fields"]["a1_q16"])
        assert runs_as_told(ONE_GAIN, made["fields"], stored) >= 1
        told = LIBRARY.noise_gain(made["fields"]["b0_uq16"], made["fields"]["a1_q16"])
        assert abs(told / made["noise_gain"] - 1) < 2 ** -11, (told, made)
        assert made["noise_gain"] == float(stored.noise_gain())


@test
def steady_kalman_filter_has_the_gain_told():
    for error in (0.8, 3.0, 20.0, 150.0):
        result, _ = answer(*BASE, "--error", error * 0.01, "--at", "100")
        made = [one for one in result["configurations"] if one.get("filter") == PLAIN][0]
        assert compiles_and_runs(made["initialiser"], PLAIN)
        ok, state = LIBRARY.make(PLAIN, made["fields"])
        assert ok
        for n in range(2000):
            LIBRARY.update(state, 0)
        wanted = made["b"][0]
        assert abs(LIBRARY.gain(state) / wanted - 1) < 4e-3, (error, LIBRARY.gain(state), wanted)
    result, _ = answer(*BASE, "--error", "0.0005", "--at", "100")
    assert "none" in result["configurations"][-1], "its gain ends at 0.77"


@test
def that_of_white_jerk_has_the_gain_told():
    for rate, error, jerk in (("50", "3", "4000"), ("25", "0.5", "400"), ("200", "0.6", "1000")):
        result, _ = answer("--rate", rate, "--sigma", "2", "--no-pictures", "-v", "3", "-k", "0", "-l", "2", "--error", error, "--at", jerk)
        made = [one for one in result["configurations"] if one.get("filter") == OF_JERK][0]
        assert made["dynamic_error"] <= float(error) / float(jerk) * float(rate) ** 3 * (1 + 1e-9), made
        assert compiles_and_runs(made["initialiser"], OF_JERK)
        ok, state = LIBRARY.make(OF_JERK, made["fields"])
        assert ok
        for n in range(4000):
            LIBRARY.update(state, 0)
        wanted = made["b"][0]
        assert abs(LIBRARY.gain(state) / wanted - 1) < 2e-2, (rate, LIBRARY.gain(state), wanted)


@test
def a_schedule_ends_at_the_filter_told():
    for a, b in (("0", str(2 / 3)), (str(-1 / 6), str(11 / 13))):
        result, _ = answer(*BASE, f"--a={a}", "--b", b)
        made = [one for one in result["configurations"] if one.get("filter") == SCHEDULED]
        assert len(made) == 1 and compiles_and_runs(made[0]["initialiser"], SCHEDULED), result["configurations"]
        ok, state = LIBRARY.make(SCHEDULED, made[0]["fields"])
        assert ok
        for n in range(200):
            LIBRARY.update(state, 0)
        assert abs(LIBRARY.gain(state) - float(b)) < 1 / 65536, LIBRARY.gain(state)


@test
def the_default_filter_is_recognised():
    result, out = answer(*BASE, "--a=0", "--b", "0.3")
    ok, state = LIBRARY.make(ONE_GAIN, result["configurations"][0]["fields"])
    assert ok and result["configurations"][0]["fields"]["b0_uq16"] == 19661
    assert result["switching"]["verdict"] == "safe" and "safe: stable" in out
    result, out = answer(*BASE, "--a=0", "--b", "0.29")
    assert result["switching"]["verdict"] == "unsafe" and "NOT safe" in out and "b0 0.29" in out
    result, _ = answer(*BASE, "--a=0", "--b", "0.29", "--band", "b0=0.29..0.6")
    assert result["switching"]["verdict"] == "safe" and "[0.29, 0.6]" in result["switching"]["band"]


@test
def the_report_tells_what_was_computed():
    result, out = answer("--rate", "10", "--sigma", "0.5", "--unit", "m", "--a=-0.3", "--b", "0.1", "--at", "5", "--no-pictures")
    f = Filter(2, (-0.3,), (0.1,))
    assert "0.4534 m" in out and "0.315 m" in out and "0.822357" in out, out
    assert result["design"]["settled_at_sample"] == response.step(f).settled_at == 90
    assert abs(result["design"]["noise_gain_lyapunov"] - result["design"]["noise_gain"]) < 1e-9
    assert result["order"] == [2, 1, 0] and result["design"]["characteristic"] == [float(x) for x in f.characteristic]
    assert "(1 - z^-1)^2 (1 - 0.3 z^-1) = 1 - 2.3 z^-1 + 1.6 z^-2 - 0.3 z^-3" in out
    assert "x_e = 2.3 x1 - 1.6 x2 + 0.3 x3;  u = g - x_e;  x = x_e + 0.1 u" in out
    assert "1 - 2.07 z^-1 + 1.44 z^-2 - 0.27 z^-3" in out
    band = switching.Band(2, ((-0.3, 0.0),), ((0.1, 1.0),))
    assert abs(result["switching"]["low"] - switching.bounds(band).low) < 1e-12


@test
def both_structures_stand_side_by_side():
    result, out = answer(*BASE, "--error", "0.09", "--at", "100")
    rows = {row["name"]: row for row in result["alternatives"]}
    alpha_beta, kalman = rows["(2, 0, 1) alpha-beta"], rows[f"(2, 0, 1) steady Kalman ({PLAIN})"]
    assert abs(result["design"]["noise_gain"] - 0.513514) < 1e-5 and abs(alpha_beta["noise_gain"] - 13 / 49) < 1e-9
    assert alpha_beta["noise_gain"] <= kalman["noise_gain"] and abs(kalman["dynamic_error"] - 9) < 1e-9
    assert all(name in out for name in rows)


@test
def pictures_are_drawn():
    folder = OUT / "pictures"
    for path in folder.glob("*"):
        path.unlink()
    result, out = answer("--rate", "10", "--sigma", "3", "--error", "3", "--at", "100", "--out", folder)
    assert result["pictures"] == [str(folder / "design.png"), str(folder / "design.svg")] and str(folder / "design.png") in out
    picture = matplotlib.image.imread(folder / "design.png")
    assert picture.shape[0] > 500 and picture.shape[1] > 800
    used = (picture[:, :, :3].max(axis=2) - picture[:, :, :3].min(axis=2)) > 0.3  # what is coloured: curves
    height, width = used.shape
    for rows, columns in ((slice(0, height // 2), slice(0, width // 2)), (slice(0, height // 2), slice(width // 2, width)),
                          (slice(height // 2, height), slice(0, width // 2)), (slice(height // 2, height), slice(width // 2, width))):
        assert used[rows, columns].sum() > 150, "a panel without a curve"
    assert "<svg" in (folder / "design.svg").read_text(encoding="utf-8")


@test
def the_noise_of_a_recording_is_measured():
    for name, sigma in (("rest-0.7lsb", 0.7), ("rest-2lsb", 2.0), ("rest-4lsb", 4.0), ("rest-8lsb", 8.0)):
        found = measure.sigma_of_stream(f"sim/streams/{name}.csv")
        true = math.sqrt(sigma * sigma + 1 / 12)  # rounding to whole LSB adds its own
        assert abs(found / true - 1) < 0.08, (name, found, true)
    chance = random.Random(9)
    samples = [round(chance.gauss(0, 3) + 50 * math.sin(n / 20) + (400 if n % 50 == 0 else 0)) for n in range(5000)]
    assert abs(measure.sigma_of(samples) / 3 - 1) < 0.12, measure.sigma_of(samples)


@test
def the_rates_are_those_of_the_protocol():
    text = pathlib.Path("docs/protocol.md").read_text(encoding="utf-8")
    assert re.search(r"^\| `rate HZ` \| 12\.5 25 50 100 200 400 800 ", text, re.M), "the rates that the tool knows are those of the firmware"


@test
def it_runs_as_a_program():
    python = sys.executable
    done = run(python, "tools/design", "--help")
    assert "order of astatism" in done.stdout and "examples" in done.stdout and max(map(len, done.stdout.splitlines())) <= 150
    done = run(python, "tools/design", "--rate", "100", "--sigma", "-1", "--noise-gain", "0.6", expect=1)
    assert done.stderr.startswith("design: --sigma is -1") and done.stderr.count("\n") == 1, done.stderr
    examples = re.findall(r"^  python tools/design (.*?)(?:   .*)?$", command.EPILOG, re.M)
    assert len(examples) == 5
    for example in examples:
        words = example.split()
        if words[0] == "schedule":
            if not pathlib.Path("tools/design/schedule.py").exists():
                continue
            assert "a1" in run(python, "tools/design", *words).stdout
            continue
        run(python, "tools/design", *words, "--out", OUT / "examples", *(["--json", OUT / "example.json"] if "--json" in words else []))


if __name__ == "__main__":
    sys.exit(run_all())
