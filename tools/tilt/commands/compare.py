"""Which filter suits a recording: runs all of them over it, side by side.

With truth columns (roll_true_cdeg, pitch_true_cdeg) filters are ranked by the angle between the filtered and the true direction; without them,
by the distance of each sample from its prediction, at most 4 sigmas each. `vs best`: how much worse, or `same` if the recording is too short or
too noisy to prove a difference.
"""
import json

from tilt import PLAIN, ROBUST
from tilt.commands import replay

NAME = "compare"
SUMMARY = "compare all filters on one recording: which is best, and why"
TRUTH_HEAD = ("tilt rms", "roll rms", "pitch rms", "worst", "lag ms", "gated %", "re-acq.", "vs best")
TRUTH_KEYS = ("tilt_rms_deg", "roll_rms_deg", "pitch_rms_deg", "worst_deg", "lag_ms", "gated_percent", "reacquired")
BLIND_HEAD = ("misses by", "NIS", "lag-1", "wander", "gated %", "re-acq.", "vs best")
BLIND_KEYS = ("misses_sigma", "nis", "lag1", "wander_deg", "gated_percent", "reacquired")
FORMS = {"lag_ms": "{:.0f}", "gated_percent": "{:.2f}", "reacquired": "{}", "worst_deg": "{:.2f}"}
OUTLIERS_PERCENT, STILL_SHARE = 1.0, 0.8  # limits above which the verdict mentions them


def arguments(parser):
    replay.stream_arguments(parser)
    parser.add_argument("--json", action="store_true", help="print all results as one JSON object")


def facts_of(stream, tables, rate_dhz):
    """Properties of the recording itself: {outliers_percent, rest_seconds, still_share}, and the stretches at rest."""
    import numpy as np
    from tilt import judge, rest

    rows = next(iter(tables.values()))
    state = judge.states(rows)
    found = rest.find(rows["lsb"], (state == 1).all(axis=1), rate_dhz / 10)
    probes = judge.probes_of(ROBUST, rate_dhz, rows, state)
    use = judge.judged([probes])
    far = [judge.innovations(axis)[use] ** 2 > judge.CUT ** 2 * judge.variance_of(axis)[use] / judge.BOARD_FACTOR for axis in probes]
    outliers = 100.0 * float(np.mean(far)) if np.any(use) else 0.0
    facts = {"outliers_percent": outliers, "rest_seconds": found.seconds, "still_share": found.seconds / max(stream.seconds, 1e-9)}
    return facts, found, [float(np.sqrt(np.median(axis["r_lsb2_q8"]) / 256.0 / judge.BOARD_FACTOR)) for axis in probes]


def scores_with_truth(stream, tables):
    """{filter: numbers}, {filter: loss per row}"""
    from tilt import judge

    use = judge.scored(tables)
    both = {name: judge.against_truth(stream, rows, use) for name, rows in tables.items()}
    return {name: numbers for name, (numbers, _) in both.items()}, {name: loss for name, (_, loss) in both.items()}


def scores_without(tables, rate_dhz, found, sigma_lsb):
    from tilt import judge

    rows = next(iter(tables.values()))
    state = judge.states(rows)
    probes = {name: judge.probes_of(name, rate_dhz, rows, state) for name in tables}
    use = judge.judged(probes.values())
    numbers, losses = {}, {}
    for name, axes in probes.items():
        numbers[name], losses[name] = judge.by_innovations(axes, use, sigma_lsb)
        numbers[name]["wander_deg"] = judge.wander_deg(tables[name], found.stretches)
    return numbers, losses


def ranked(tables, numbers, losses, rate_hz):
    """Filters, best first: their numbers, how much worse than the best in percent of rms, and whether the difference is significant."""
    from tilt import judge

    order = sorted(losses, key=lambda name: losses[name].mean())
    best = losses[order[0]]
    found = []
    for name in order:
        away = judge.difference(losses[name], best, rate_hz)
        worse = 100.0 * (float((losses[name].mean() / best.mean()) ** 0.5) - 1.0) if best.mean() > 0.0 else 0.0
        flags = tables[name]["flags"]
        found.append({"filter": name, **numbers[name], "gated_percent": replay.share(flags, 1), "reacquired": int(((flags & 4) != 0).sum()),
                      "worse_percent": worse, "told_from_best": name != order[0] and away.significant})
    return found


def judgement(stream, tables, rate_dhz):
    """The whole result, as --json prints it."""
    from tilt import judge, native
    from tilt.errors import TiltError

    facts, found, sigma_lsb = facts_of(stream, tables, rate_dhz)
    scores = scores_with_truth(stream, tables) if stream.has_truth else scores_without(tables, rate_dhz, found, sigma_lsb)
    count = len(next(iter(scores[1].values())))
    if count == 0:
        raise TiltError(f"{stream.path}: no row to judge by: all {len(stream)} rows are missing or at the start of the filters")
    filters = ranked(tables, *scores, rate_dhz / 10)
    same = [row["filter"] for row in filters if not row["told_from_best"]]
    answer = {"stream": stream.path, "rate_hz": rate_dhz / 10, "seconds": stream.seconds, "rows_judged": count,
              "criterion": "angle from the truth" if stream.has_truth else "innovations", **facts, "filters": filters,
              "best": filters[0]["filter"], "flash": native.flashed_by(filters[0]["filter"]), "same_as_best": same[1:],
              "enough": count >= judge.BATCHES * judge.BATCH_MIN}
    return answer | {"why": why(answer)}


def size(row):
    return f"{row['tilt_rms_deg']:.2f} degrees rms" if "tilt_rms_deg" in row else f"{row['misses_sigma']:.3f} sigma"


def why(answer):
    """Sentences: the best filter, whether it differs from the others, and which property of the recording decides."""
    rows = {row["filter"]: row for row in answer["filters"]}
    best = answer["filters"][0]
    if len(rows) == 1:
        return [f"{best['filter']}: {size(best)}; nothing to compare with."]
    said = [f"Best: {best['filter']}, {size(best)}" + (" from the truth." if "tilt_rms_deg" in best else " from what it predicted.")]
    if not answer["enough"]:
        said.append(f"{answer['rows_judged']} rows are too few to distinguish filters.")
    elif answer["same_as_best"]:
        said.append(f"Within the noise of this recording it is no better than {', '.join(answer['same_as_best'])}: keep the one you know.")
    others = [row for row in answer["filters"] if row["told_from_best"]]
    if others:
        listed = ", ".join(f"{row['filter']} {row['worse_percent']:.0f} %" for row in others)
        said.append(f"Certainly worse: {listed}.")
    return said + reasons(answer, rows, best)


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
    elif best.get("lag_ms") is not None:
        said.append(f"It moves, and the best filter lags by {best['lag_ms']:.0f} ms.")
    return said


def table(answer):
    truth = answer["criterion"] != "innovations"
    head, keys = (TRUTH_HEAD, TRUTH_KEYS) if truth else (BLIND_HEAD, BLIND_KEYS)
    lines = [f"{'filter':<11}" + "".join(f"{text:>11}" for text in head)]
    for place, row in enumerate(answer["filters"]):
        cells = ["-" if row[key] is None else FORMS.get(key, "{:.3f}").format(row[key]) for key in keys]
        mark = "best" if place == 0 else f"+{row['worse_percent']:.1f} %" if row["told_from_best"] else "same"
        lines.append(f"{row['filter']:<11}" + "".join(f"{text:>11}" for text in (*cells, mark)))
    unit = "degrees" if truth else "misses by: sigmas of a sample's noise; wander: degrees at rest"
    return [f"{answer['stream']}: {answer['rows_judged']} rows judged by {answer['criterion']} ({unit})", *lines, ""]


def run(args):
    from tilt import native, stream as streams

    stream = streams.read(args.stream)
    rate_dhz = native.rate_of(stream, args.rate)
    answer = judgement(stream, replay.replayed(stream, native.chosen(args.filter), rate_dhz), rate_dhz)
    if args.json:
        print(json.dumps(answer, indent=1))
    else:
        print("\n".join(table(answer) + answer["why"] + [f"flash: {answer['flash']}"]))
