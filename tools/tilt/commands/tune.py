"""Estimates R, q and gate from a recording, and prints the commands that set them on the board.

R is the variance of the readings at rest. q, how hard the motion is driven, is the most likely value for the readings in motion. The gate is the
one with the smallest prediction error. The output states what the recording cannot show. If the filters' model does not fit, the status is 1, and
the commands are the best that the model can do.
"""
import json

from tilt import ROBUST

NAME = "tune"
SUMMARY = "estimate R, q and gate from a recording for the board"
DEFAULT_FILTER = ROBUST


def arguments(parser):
    parser.add_argument("stream", metavar="STREAM", help="recording (docs/protocol.md, Streams): some seconds at rest, then typical motion")
    parser.add_argument("--filter", metavar="NAME", default=DEFAULT_FILTER, help=f"a filter with a q in LSB2/s3 (default {DEFAULT_FILTER})")
    parser.add_argument("--json", action="store_true", help="print all results as one JSON object")


def tunable(name, rate_dhz):
    """Parameters of a filter with the q that is sought; TiltError for any other filter."""
    from tilt import native
    from tilt.errors import TiltError

    if native.chosen(name) != [name]:
        raise TiltError(f"--filter {name}: give one filter")
    every = native.parameters(name, rate_dhz)
    if every.get("q") is None or every["q"].unit != "LSB2/s3":
        fitting = [other for other in native.filters() if getattr(native.parameters(other, rate_dhz).get("q"), "unit", "") == "LSB2/s3"]
        raise TiltError(f"--filter: {name} has no q in LSB2/s3; choose from {' '.join(fitting)}")
    return every


def rate_of(stream):
    from tilt.errors import TiltError

    rate_dhz = round(stream.rate_hz * 10)
    if not 50 <= rate_dhz <= 40000:
        raise TiltError(f"{stream.path}: rows at {stream.rate_hz:.1f} Hz; the filters take 5 to 4000 Hz")
    return rate_dhz


def measured(stream, every, name):
    """The whole result, as --json prints it."""
    import numpy as np
    from tilt import model
    from tilt.progress import bar

    samples = model.gridded(stream, rate_of(stream))
    board = model.board_r_lsb2(samples)
    with bar("q", "run") as report:
        if samples.rest.r_lsb2 is None:
            r_lsb2, drive = model.find_both(samples, board / model.judge.BOARD_FACTOR, report)
        else:
            r_lsb2 = np.clip(samples.rest.r_lsb2, every["r"].low, every["r"].high)
            drive = model.find_q(samples, r_lsb2, report)
    answer = {"stream": stream.path, "filter": name, "rate_hz": samples.rate_dhz / 10, "r_lsb2": r_lsb2.tolist(), "board_r_lsb2": board.tolist(),
              "rest_seconds": samples.rest.seconds, "rest_stretches": len(samples.rest.stretches), "q": drive.q, "q_low": drive.low,
              "q_high": drive.high, "troubles": [drive.trouble] if drive.trouble else [], "commands": []}
    if drive.trouble:
        return answer
    fit = model.fit_of(samples, r_lsb2, drive.q)
    answer |= {"nis": fit.nis, "lag1": fit.correlation, "outliers_percent": 100.0 * fit.outliers, "troubles": fit.troubles()}
    return answer | for_the_board(samples, every, name, drive.q * board_factor(board, r_lsb2), np.sqrt(r_lsb2))


def board_factor(board, r_lsb2):
    """The gain depends on q / R, so q is scaled with the board's R: geometric mean over the axes."""
    import numpy as np

    return float(np.exp(np.mean(np.log(board / r_lsb2))))


def for_the_board(samples, every, name, q, sigma_lsb):
    """Commands, and how they compare with the filter's defaults."""
    from tilt import model, native

    values, found = {"q": q}, {}
    if "gate" in every:
        gate, equal = model.find_gate(samples, name, q, sigma_lsb, every["gate"].default)
        values["gate"] = gate
        found = {"gate": gate, "gates_as_good": equal}
    away, tuned, shipped = model.compared(samples, name, values, {}, sigma_lsb)
    worse = away.significant and away.mean > 0.0
    commands = [f"filter {name}"] + [f"{key} {every[key].text(value)}" for key, value in values.items() if not worse]
    return found | {"board_q": q, "commands": commands, "flash": native.flashed_by(name),
                    "better_percent": 100.0 * (1.0 - (tuned / shipped) ** 0.5), "better_told": away.significant}


def lines(answer):
    def three(values, form):
        return " ".join(form.format(value) for value in values)

    r = answer["r_lsb2"]
    stretches = "1 stretch" if answer["rest_stretches"] == 1 else f"{answer['rest_stretches']} stretches"
    where = f"{stretches} at rest, {answer['rest_seconds']:.1f} s" if answer["rest_stretches"] else \
        "no stretch at rest found: R is an unchecked estimate from the innovations in motion"
    said = [f"{answer['stream']}: {where}",
            f"R     {three(r, '{:.2f}')} LSB^2 (x y z; rms {three([value ** 0.5 for value in r], '{:.2f}')} LSB); the board estimates it itself and "
            f"takes {three(answer['board_r_lsb2'], '{:.2f}')}"]
    if answer["commands"]:
        said += [f"q     {answer['q']:.0f} LSB2/s3 (95 %: {answer['q_low']:.0f} to {answer['q_high']:.0f}); with the board's R "
                 f"{answer['board_q']:.0f}"]
        if "gate" in answer:
            equal = answer["gates_as_good"]
            as_good = f" ({equal[0]:g} to {equal[-1]:g} are equally good)" if len(equal) > 1 else ""
            said += [f"gate  {answer['gate']:g} sigma{as_good}; {answer['outliers_percent']:.2f} % of the readings lie beyond 4"]
        said += [f"fit   squared innovations {answer['nis']:.2f} of the model's, correlation of neighbours {answer['lag1']:+.2f}"]
    return said + verdict(answer)


def verdict(answer):
    said = [f"the model does not fit: {trouble}" for trouble in answer["troubles"]]
    if not answer["commands"]:
        return said + ["no commands: keep the filter's defaults"]
    if not said:
        said = ["the model fits"]
    shipped = f"the defaults of {answer['filter']}"
    if not answer["better_told"]:
        said.append(f"over the whole recording it predicts no better than with {shipped}, within the noise")
    elif answer["better_percent"] > 0:
        said.append(f"over the whole recording it predicts {answer['better_percent']:.1f} % better than with {shipped}")
    else:
        said.append(f"over the whole recording, rest included, it predicts {-answer['better_percent']:.1f} % worse than with {shipped}: keep them")
    return said + [f"flash: {answer['flash']}", "", *answer["commands"]]


def run(args):
    from tilt import stream as streams

    stream = streams.read(args.stream)
    if len(stream) < 2 or not stream.step_us:
        from tilt.errors import TiltError
        raise TiltError(f"{stream.path}: all rows have the same time, so the rate is unknown")
    every = tunable(args.filter, rate_of(stream))
    answer = measured(stream, every, args.filter)
    print(json.dumps(answer, indent=1) if args.json else "\n".join(lines(answer)))
    return 1 if answer["troubles"] else 0
