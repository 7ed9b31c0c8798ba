"""Which filter suits a recording: runs all of them over it, side by side.

With truth columns (roll_true_cdeg, pitch_true_cdeg) filters are ranked by the angle between the filtered and the true direction; without them,
by their distance from the recording itself, smoothed without lag and without its outliers. `vs best`: how much worse (95 % interval), or `same`
if the recording is too short or too noisy to prove a difference. Filters that are there to compare with the papers are shown as `published`
and never recommended.
"""
import json

from tilt import PLAIN, ROBUST
from tilt.commands import replay

NAME = "compare"
SUMMARY = "compare all filters on one recording: which is best, and why"
TRUTH_HEAD = ("tilt rms", "roll rms", "pitch rms", "worst", "lag ms", "gated %", "re-acq.", "cycles", "vs best")
TRUTH_KEYS = ("tilt_rms_deg", "roll_rms_deg", "pitch_rms_deg", "worst_deg", "lag_ms", "gated_percent", "reacquired", "cycles")
BLIND_HEAD = ("error", "NIS", "wander", "lag ms", "gated %", "re-acq.", "cycles", "vs best")
BLIND_KEYS = ("error_lsb", "nis", "wander_deg", "lag_ms", "gated_percent", "reacquired", "cycles")
FORMS = {"gated_percent": "{:.2f}", "reacquired": "{}", "worst_deg": "{:.2f}", "cycles": "{}"}
OUTLIERS_PERCENT, STILL_SHARE = 1.0, 0.8  # limits above which the verdict mentions them


def arguments(parser):
    replay.stream_arguments(parser)
    parser.add_argument("--json", action="store_true", help="print all results as one JSON object")


def rows_of(tables):
    """The rows common to all filters, and their states."""
    from tilt import judge

    rows = next(iter(tables.values()))
    return rows, judge.states(rows)


def facts_of(stream, tables, rate_dhz):
    """Properties of the recording itself: {outliers_percent, rest_seconds, still_share}, and the stretches at rest."""
    import numpy as np
    from tilt import judge, rest, smoother

    rows, state = rows_of(tables)
    found = rest.find(rows["lsb"], smoother.complete(state == 1), rate_dhz / 10)
    probes = judge.probes_of(ROBUST, rate_dhz, rows, state)
    use = judge.judged([probes])
    far = [judge.innovations(axis)[use] ** 2 > judge.CUT ** 2 * judge.variance_of(axis)[use] / judge.BOARD_FACTOR for axis in probes.values()]
    outliers = 100.0 * float(np.mean(far)) if np.any(use) else 0.0
    facts = {"outliers_percent": outliers, "rest_seconds": found.seconds, "still_share": found.seconds / max(stream.seconds, 1e-9)}
    return facts, found


def scores_with_truth(stream, tables):
    """{filter: numbers}, {filter: loss per row}"""
    from tilt import judge

    use = judge.scored(tables)
    both = {name: judge.against_truth(stream, rows, use) for name, rows in tables.items()}
    return {name: numbers for name, (numbers, _) in both.items()}, {name: loss for name, (_, loss) in both.items()}


def scores_without(tables, rate_dhz):
    from tilt import judge, smoother

    rows, state = rows_of(tables)
    probes = {name: judge.probes_of(name, rate_dhz, rows, state) for name in tables}
    use = judge.judged(probes.values())
    use = use & smoother.fair(rows["t_us"], rate_dhz / 10) if use.any() else use
    reference = smoother.smoothed(rows["lsb"], state == 1, rate_dhz / 10)
    both = {name: judge.against_smoothed(rows["t_us"], axes, reference, use) for name, axes in probes.items()}
    return {name: numbers for name, (numbers, _) in both.items()}, {name: loss for name, (_, loss) in both.items()}


def best_of(losses):
    """(filters by their loss, the one to recommend: the first that is not published only, else the first)"""
    from tilt import native

    order, published = sorted(losses, key=lambda name: losses[name].mean()), native.published_only()
    return order, next((name for name in order if name not in published), order[0])


def ranked(tables, numbers, losses, rate_hz):
    """Filters, least error first: their numbers, how much worse than the best in percent of rms, and whether the difference is significant."""
    from tilt import judge, native

    order, chosen = best_of(losses)
    best, published = losses[chosen], native.published_only()
    found = []
    for name in order:
        away = judge.difference(losses[name], best, rate_hz)
        low, middle, high = (worse_percent(best.mean(), value) for value in (away.interval[0], away.mean, away.interval[1]))
        flags = tables[name]["flags"]
        found.append({"filter": name, **numbers[name], "gated_percent": replay.share(flags, 1), "reacquired": int(((flags & 4) != 0).sum()),
                      "cycles": native.cycles(name), "worse_percent": middle, "worse_low_percent": low, "worse_high_percent": high,
                      "published_only": name in published, "told_from_best": name != chosen and away.significant})
    return found


def worse_percent(best, away):
    """Of the rms, where the mean square is further from the best's by so much."""
    return 100.0 * (max(1.0 + away / best, 0.0) ** 0.5 - 1.0) if best > 0.0 and away < float("inf") else 0.0


def judgement(stream, tables, rate_dhz):
    """The whole result, as --json prints it."""
    from tilt import judge, native
    from tilt.errors import TiltError

    facts, found = facts_of(stream, tables, rate_dhz)
    scores = scores_with_truth(stream, tables) if stream.has_truth else scores_without(tables, rate_dhz)
    count = len(next(iter(scores[1].values())))
    if count == 0:
        raise TiltError(f"{stream.path}: no row to judge by: all {len(stream)} rows are missing or at the start of the filters: record longer")
    for name, rows in tables.items():
        scores[0][name]["wander_deg"] = judge.wander_deg(rows, found.stretches)
    filters, best = ranked(tables, *scores, rate_dhz / 10), best_of(scores[1])[1]
    same = [row["filter"] for row in filters if not row["told_from_best"] and not row["published_only"] and row["filter"] != best]
    answer = {"stream": stream.path, "rate_hz": rate_dhz / 10, "seconds": stream.seconds, "rows_judged": count,
              "criterion": "angle from the truth" if stream.has_truth else "distance from the recording smoothed without lag", **facts,
              "filters": filters, "best": best, "flash": native.flashed_by(best), "same_as_best": same,
              "enough": count >= judge.BATCHES * judge.BATCH_MIN}
    return answer | {"why": why(answer)}


def size(row):
    return f"{row['tilt_rms_deg']:.2f} degrees rms" if "tilt_rms_deg" in row else f"{row['error_lsb']:.2f} LSB rms"


def why(answer):
    """Sentences: the best filter, whether it differs from the others, and which property of the recording decides."""
    rows = {row["filter"]: row for row in answer["filters"]}
    best = rows[answer["best"]]
    if len(rows) == 1:
        return [f"{best['filter']}: {size(best)}; nothing to compare with."]
    said = [f"Best: {best['filter']}, {size(best)} from the {'truth' if 'tilt_rms_deg' in best else 'smoothed recording'}."]
    if best["published_only"]:
        said.append("It is there to compare with its paper: add another filter for a recommendation.")
    if not answer["enough"]:
        said.append(f"{answer['rows_judged']} rows are too few to distinguish filters.")
    elif answer["same_as_best"]:
        said.append(f"Within the noise of this recording it is no better than {', '.join(answer['same_as_best'])}: keep the one you know.")
    others = [row for row in answer["filters"] if row["told_from_best"] and row["worse_percent"] > 0.0]
    if others:
        listed = ", ".join(f"{row['filter']} {much(row)}" for row in others)
        said.append(f"Certainly worse: {listed}.")
    return said + reasons(answer, rows, best) + [price(best)]


def much(row):
    """How much worse than the best."""
    worse = row["worse_percent"]
    return f"{worse:+.1f} %" if worse < 100.0 else f"{1.0 + worse / 100.0:.1f} times"


def price(best):
    """What the choice costs."""
    lag = "a lag that the recording does not show" if best["lag_ms"] is None else f"a lag of {whole(best['lag_ms'])} ms"
    noise = "" if best["wander_deg"] is None else f", {best['wander_deg']:.3f} degrees rms at rest"
    return f"{best['filter']} costs {lag}{noise}, and at most {best['cycles']} cycles a sample and axis."


def whole(value):
    return f"{round(value)}"


def reasons(answer, rows, best):
    said = []
    if answer["outliers_percent"] >= OUTLIERS_PERCENT:
        plain = f"; {PLAIN}, which accepts all, is at {size(rows[PLAIN])}" if PLAIN in rows and best["filter"] != PLAIN else ""
        said.append(f"{answer['outliers_percent']:.1f} % of the readings lie more than 4 sigmas from where {ROBUST} expects them{plain}.")
    else:
        said.append(f"{answer['outliers_percent']:.2f} % of the readings lie more than 4 sigmas from where {ROBUST} expects them: hardly any "
                    "outliers.")
    if answer["still_share"] >= STILL_SHARE:
        said.append(f"At rest for {100 * answer['still_share']:.0f} % of the time: a long memory wins here, but would lag in motion.")
    return said


def table(answer):
    truth = "tilt_rms_deg" in answer["filters"][0]
    head, keys = (TRUTH_HEAD, TRUTH_KEYS) if truth else (BLIND_HEAD, BLIND_KEYS)
    lines = [f"{'filter':<11}" + "".join(f"{text:>10}" for text in head)]
    for row in answer["filters"]:
        cells = ["-" if row[key] is None else whole(row[key]) if key == "lag_ms" else FORMS.get(key, "{:.3f}").format(row[key]) for key in keys]
        lines.append(f"{row['filter']:<11}" + "".join(f"{text:>10}" for text in (*cells, mark(answer, row))) + interval(row))
    unit = "degrees" if truth else "error: LSB rms; wander: degrees at rest"
    return [f"{answer['stream']}: {answer['rows_judged']} rows judged by {answer['criterion']} ({unit})", *lines, ""]


def mark(answer, row):
    if row["filter"] == answer["best"]:
        return "best"
    return "published" if row["published_only"] else much(row) if row["told_from_best"] else "same"


def interval(row):
    if not row["told_from_best"] or row["published_only"] or row["worse_percent"] >= 100.0:
        return ""
    return f"  ({row['worse_low_percent']:.0f}..{row['worse_high_percent']:.0f})"


def run(args):
    from tilt import Stream, native

    stream = Stream.read(args.stream)
    rate_dhz = native.rate_of(stream, args.rate)
    answer = judgement(stream, replay.replayed(stream, native.chosen(args.filter), rate_dhz), rate_dhz)
    if args.json:
        print(json.dumps(answer, indent=1))
    else:
        print("\n".join(table(answer) + answer["why"] + [f"flash: {answer['flash']}"]))
