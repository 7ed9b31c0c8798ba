"""The tables of docs/results/papers-000.md."""
import fnmatch

from papers_page import BESIDE, grid, pick, shown, table, verdicts, with_interval

TURNS = ("ramp30", "cos60", "minjerk60", "bump30", "sine30", "triangle30", "steps30")
LEVELS = ("-0.3:0.1", "0:0.1", "0:0.3", "-0.1:0.3", "0.9:0.3")
STREAMS = ("tilt-slow", "tilt-fast", "tilt-400hz", "through-pitch-90", "through-roll-180")
WAYS = ("angle", "angle_unwrapped", "axes")
SEARCHES = (("table1_smooth", "true error, smooth roll to 90 degrees"), ("table1_steps", "true error, abrupt steps to 90 degrees"),
            ("table1_walk", "true error, Kalman filter without a rate allowed"), ("table1_residual", "residual g - x^ for the error"),
            ("table1_any_start", "true error, any error of the start"), ("table1_any_roll", "true error, any roll and start"),
            ("table1_residual_any_roll", "residual, any roll and start"))
ADAPTIVE_TURNS = ("ramp30", "cos60", "bump30", "sine30")
ADAPTIVE_KINDS = (("clean", "clean"), ("5_percent", "5 % with 20 times the noise"), ("15_percent", "15 %"),
                  ("shift_20_sigma", "5 % shifted by 20 sigma to either side"))
# experiments without chance: their tables are the same for every seed and number of runs
CHANCE_FREE = ("schedule_*", "algorithm_22_*", "table1_*", "equal_noise*", "roll_tilt-*", "roll_through-*", "complexity")


def windows(prefix="mse", names=("0_5", "6_10", "11_15")):
    return [f"{prefix}_{name}" for name in names]


def of(rows, *patterns):
    return [row for row in rows if any(fnmatch.fnmatchcase(row["experiment"], p) for p in patterns)]


def limited(row):
    """A number with the limit that it is held to beside it."""
    bound = row.get("limit")
    return shown(row["value"]) + (f" (<= {shown(bound)})" if bound is not None else "")


def chosen_guard(rows):
    """Its gate in sigmas as shipped."""
    row = pick(rows, "adaptive_defaults", "adaptive", "fixed", "guard_sigma")
    return row["value"] if row else None


def adaptive_table(rows):
    """A line for each kind of samples, without the guard and with the shipped one; a column for each roll."""
    lines = []
    for name, words, kinds in (("adaptive(guard=0)", "no guard", ADAPTIVE_KINDS[:1]),
                               (f"adaptive(guard={chosen_guard(rows) or 0:g})", "guard as shipped", ADAPTIVE_KINDS)):
        for kind, title in kinds:
            cells = [[pick(rows, f"adaptive_{kind}_{turn}", name, "fixed", metric) for metric in windows(names=("0_5", "2_5", "6_10", "11_15"))]
                     for turn in ADAPTIVE_TURNS]
            if all(row for found in cells for row in found):
                lines.append([f"`{name}`", f"{words}, {title}", *(" / ".join(limited(row) for row in found) for found in cells)])
    return table(["filter", "samples", *ADAPTIVE_TURNS], lines)


def guard_table(rows):
    """What the width of the gate trades: a line for each."""
    chosen, lines = chosen_guard(rows), []
    for name in dict.fromkeys(row["filter"] for row in of(rows, "adaptive_clean_sine30")):
        at = lambda kind, turn, window: pick(rows, f"adaptive_{kind}_{turn}", name, "fixed", f"mse_{window}")["value"]
        guard = float(name[len("adaptive(guard="):-1])
        words = "none" if guard == 0 else f"{guard:g} sigma" + (", as shipped" if guard == chosen else "")
        lines.append([f"`{name}`", words, *(shown(at(kind, "sine30", "6_10")) for kind, _ in ADAPTIVE_KINDS[:3]),
                      shown(at("5_percent", "bump30", "6_10")),
                      shown(max(at("5_percent", turn, "11_15") for turn in ADAPTIVE_TURNS[:3]))])
    return table(["filter", "gate", "sine30, clean", "5 %", "15 %", "bump30, 5 %", "11-15 s, 5 %: worst of the other three"], lines)


def identified_table(rows):
    """R as noise.c has it after 10 s by 1.5 times the variance: mean and deviation of a run, each with what theory says."""
    lines = []
    for experiment in dict.fromkeys(row["experiment"] for row in of(rows, "noise_*")):
        exact, mean, deviation = (pick(rows, experiment, "noise(x)", "fixed", metric) for metric in ("exact_r_by_true", "r_by_true", "r_one_run_sd"))
        lines.append(["`noise(x)`", experiment[len("noise_"):].replace("_", " "), with_interval(mean), shown(exact["value"]), limited(deviation)])
    return table(["estimator", "case", "mean by the wanted one [95 %]", "theory, without fluctuation", "deviation of one run, relative"], lines)


def schedule_table(rows):
    return grid(rows, [("in the region", "schedule_15_s", ["in_region"]), ("Pe < 0", "schedule_15_s", ["pe_negative"]),
                       ("P < 0", "schedule_15_s", ["p_negative"]), ("parting, ln per step", "schedule_15_s", ["growth"]),
                       ("true variance by R, median", "schedule_15_s", ["true_variance_median"]),
                       ("later: in the region", "schedule_later", ["in_region"]), ("period", "schedule_later", ["period"]),
                       ("true variance by R", "schedule_later", ["true_variance_median"])])


def search_table(rows):
    lines = []
    for experiment, title in SEARCHES:
        found = {row["metric"]: row["value"] for row in of(rows, experiment)}
        name = next((row["filter"] for row in of(rows, experiment)), None)
        if name:
            lines.append([f"`{name}`", title, " / ".join(shown(found[m]) for m in windows()), f"{100 * found['largest_difference']:.1f} %",
                          *(shown(found[m]) for m in ("amplitude", "r", "start_error")), f"({found['a1']:g}, {found['b0']:g})",
                          shown(found["kalman_alpha"])])
    return table(["Kalman filter / roll", "reading", "its row (paper: 0.489 / 1.419 / 0.359)", "largest difference", "degrees", "R", "start's error",
                  "(a1, b0)", "alpha"], lines)


def equal_noise_tables(rows):
    for level in LEVELS:
        name = f"equal_noise({level})"
        yield f"Equal noise gain, a1:b0 = {level}: bias^2 in 6-10 s / largest error, degrees", grid(rows, [("noise gain", name, ["noise_gain"]), *(
            (turn, name, [f"bias2_{turn}", f"peak_{turn}"]) for turn in TURNS)])
    yield "Equal noise gain: lag of a Kalman filter of two states by that of the synthesised one (Table 1 takes 1.418)", grid(rows, [
        (title, "equal_noise_lag", [name]) for title, name in (("white rate", "kf2_rate"), ("white acceleration", "kf2_acceleration"))])
    yield "Equal noise gain, all cells: the synthesised filter against each", grid(rows, [
        ("cells", "equal_noise_all", ["cells"]), ("it loses in bias^2", "equal_noise_all", ["synth_loses"]),
        ("in largest error", "equal_noise_all", ["synth_loses_peak"]), ("its bias^2 by theirs, least", "equal_noise_all", ["bias2_ratio_least"]),
        ("most", "equal_noise_all", ["bias2_ratio_most"])])


def runs_of(runs):
    return f"{runs * 2 // 5:,} runs of each experiment with chance"


def tables(rows):
    """(heading, lines)."""
    yield BESIDE, verdicts(rows)
    yield "Operations of a sample, counted on the equations; a quotient counts as a multiplication", grid(rows, [
        (metric, "complexity", [metric]) for metric in ("multiplications", "additions", "quotients")])
    yield "Gains of (22) without data: the paper's 15 s, and after 8,000 steps", schedule_table(rows)
    yield "(22) on the roll, P(0) = 5, R = 0.6: exact mean square error in 0-5 / 6-10 / 11-15 s, degree^2", [
        line.replace("never / never / never", "0 / 0 at once") for line in grid(rows, [
            (turn, f"algorithm_22_{turn}", windows()) for turn in ("ramp30", "cos60", "bump30")])]
    yield "(22) as printed on cos60 with any R from 0.2 to 1: least / median", grid(rows, [
        (title, "algorithm_22_any_r", [f"mse_{w}_least", f"mse_{w}_median"]) for title, w in (
            ("0-5 s", "0_5"), ("6-10 s", "6_10"), ("11-15 s", "11_15"))])
    yield "The nearest to Table 1: the synthesised row is met exactly, 0.516 / 0.875 / 0.348", search_table(rows)
    yield "Constant gains from x^ = g(0), R = 0.6: exact / measured in 0-5, 6-10, 11-15 s, and the largest bias", grid(
        of(rows, "roll_ramp30", "roll_cos60", "roll_bump30"), [(f"{turn} {title}", f"roll_{turn}", [f"exact_mse_{w}", f"mse_{w}"]) for turn in (
            "ramp30", "cos60", "bump30") for title, w in (("0-5", "0_5"), ("6-10", "6_10"), ("11-15", "11_15"))])
    yield "Constant gains on the other rolls: exact in 0-5 / 6-10 / 11-15 s", grid(of(rows, "roll_*30", "roll_*60"), [
        (turn, f"roll_{turn}", windows("exact_mse")) for turn in TURNS if turn not in ("ramp30", "cos60", "bump30")])
    yield "Every shipped filter (R told, other parameters as shipped): mean square error in 2-5 / 6-10 / 11-15 s, degree^2", grid(
        rows, [(turn, f"filters_{turn}", windows(names=("2_5", "6_10", "11_15"))) for turn in TURNS])
    yield "adaptive: mean square error in 2-5 / 6-10 / 11-15 s, degree^2, the limit beside", adaptive_table(rows)
    yield "adaptive: what the width of its gate trades, mean square error in 6-10 s, degree^2", guard_table(rows)
    yield "noise: R identified in 10 s from a start hundreds of times too small, by 1.5 times the variance", identified_table(rows)
    yield from equal_noise_tables(rows)
    for stream in STREAMS:
        yield f"Roll on {stream}: rms error in degrees, filtered as an angle / unwrapped first / axes first", grid(rows, [
            (region.replace("_", " "), f"roll_{stream}", [f"rmse_{region}_{way}" for way in WAYS])
            for region in ("open", "near_90", "near_180", "all")
            if pick(rows, f"roll_{stream}", "unfiltered", "double", f"rmse_{region}_axes")])
