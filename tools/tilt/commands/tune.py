"""Finds R, q and gate in a recording, and the commands that set them on the board.

R is the variance of the readings where the recording lies still. q, how hard the motion is driven, is what makes the readings of where it moves
the most likely. The gate is the one with the least error of prediction. What cannot be told from the recording is said so, and what the
filters' model does not fit is not called a success: then the status is 1, and the commands are the best that the model can do.
"""
import json

from tilt import ROBUST

NAME = "tune"
SUMMARY = "R, q and gate from a recording, and the commands that set them"
DEFAULT_FILTER = ROBUST


def arguments(parser):
    parser.add_argument("stream", metavar="STREAM", help="recording (docs/protocol.md, Streams): some seconds at rest, then the motion that is meant")
    parser.add_argument("--filter", metavar="NAME", default=DEFAULT_FILTER, help=f"one that has a q in LSB2/s3 (default {DEFAULT_FILTER})")
    parser.add_argument("--json", action="store_true", help="everything as one JSON object")


def tunable(name, rate_dhz):
    """Parameters of a filter with the drive that is looked for; TiltError for another one."""
    from tilt import native
    from tilt.errors import TiltError

    if native.chosen(name) != [name]:
        raise TiltError(f"--filter: one filter was expected: {name}")
    every = native.parameters(name, rate_dhz)
    if every.get("q") is None or every["q"].unit != "LSB2/s3":
        fitting = [other for other in native.filters() if getattr(native.parameters(other, rate_dhz).get("q"), "unit", "") == "LSB2/s3"]
        raise TiltError(f"--filter: {name} has no q in LSB2/s3; {' '.join(fitting)} have")
    return every


def rate_of(stream):
    from tilt.errors import TiltError

    rate_dhz = round(stream.rate_hz * 10)
    if not 50 <= rate_dhz <= 40000:
        raise TiltError(f"{stream.path}: its rows come at {stream.rate_hz:.1f} Hz; filters are made for 5 to 4000 Hz")
    return rate_dhz


def measured(stream, every, name):
    """The whole answer, as --json prints it."""
    import numpy as np
    from tilt import model
    from tilt.progress import bar

    samples = model.gridded(stream, rate_of(stream))
    board = model.board_r_lsb2(samples)
    with bar("q", "run") as told:
        if samples.rest.r_lsb2 is None:
            r_lsb2, drive = model.find_both(samples, board / model.judge.BOARD_FACTOR, told)
        else:
            r_lsb2 = np.clip(samples.rest.r_lsb2, every["r"].low, every["r"].high)
            drive = model.find_q(samples, r_lsb2, told)
    answer = {"stream": stream.path, "filter": name, "rate_hz": samples.rate_dhz / 10, "r_lsb2": r_lsb2.tolist(), "board_r_lsb2": board.tolist(),
              "rest_seconds": samples.rest.seconds, "rest_stretches": len(samples.rest.stretches), "q": drive.q, "q_low": drive.low,
              "q_high": drive.high, "troubles": [drive.trouble] if drive.trouble else [], "commands": []}
    if drive.trouble:
        return answer
    fit = model.fit_of(samples, r_lsb2, drive.q)
    answer |= {"nis": fit.nis, "lag1": fit.correlation, "outliers_percent": 100.0 * fit.outliers, "troubles": fit.troubles()}
    return answer | for_the_board(samples, every, name, drive.q * board_factor(board, r_lsb2), np.sqrt(r_lsb2))


def board_factor(board, r_lsb2):
    """The gain depends on q / R, so q goes with the R that the board takes: mean over the axes, in logarithms."""
    import numpy as np

    return float(np.exp(np.mean(np.log(board / r_lsb2))))


def for_the_board(samples, every, name, q, sigma_lsb):
    """Commands, and what they are worth beside the values that the filter ships with."""
    from tilt import model, native

    values, found = {"q": q}, {}
    if "gate" in every:
        gate, equal = model.find_gate(samples, name, q, sigma_lsb, every["gate"].default)
        values["gate"] = gate
        found = {"gate": gate, "gates_as_good": equal}
    away, tuned, shipped = model.compared(samples, name, values, {}, sigma_lsb)
    worse = away.told and away.mean > 0.0
    commands = [f"filter {name}"] + [f"{key} {every[key].text(value)}" for key, value in values.items() if not worse]
    return found | {"board_q": q, "commands": commands, "flash": native.flashed_by(name),
                    "better_percent": 100.0 * (1.0 - (tuned / shipped) ** 0.5), "better_told": away.told}


def lines(answer):
    def three(values, form):
        return " ".join(form.format(value) for value in values)

    r = answer["r_lsb2"]
    stretches = "1 stretch" if answer["rest_stretches"] == 1 else f"{answer['rest_stretches']} stretches"
    where = f"{stretches} at rest, {answer['rest_seconds']:.1f} s" if answer["rest_stretches"] else \
        "no stretch at rest was found: R is what the innovations in motion leave, which cannot be checked"
    said = [f"{answer['stream']}: {where}",
            f"R     {three(r, '{:.2f}')} LSB^2 (x y z; rms {three([value ** 0.5 for value in r], '{:.2f}')} LSB); the board finds it by itself and "
            f"takes {three(answer['board_r_lsb2'], '{:.2f}')}"]
    if answer["commands"]:
        said += [f"q     {answer['q']:.0f} LSB2/s3 (95 %: {answer['q_low']:.0f} to {answer['q_high']:.0f}); with the board's R "
                 f"{answer['board_q']:.0f}"]
        if "gate" in answer:
            equal = answer["gates_as_good"]
            as_good = f" ({equal[0]:g} to {equal[-1]:g} cannot be told apart)" if len(equal) > 1 else ""
            said += [f"gate  {answer['gate']:g} sigma{as_good}; {answer['outliers_percent']:.2f} % of the readings lie beyond 4"]
        said += [f"fit   squares of innovations {answer['nis']:.2f} of the model's, correlation of neighbours {answer['lag1']:+.2f}"]
    return said + verdict(answer)


def verdict(answer):
    said = [f"the model does not fit: {trouble}" for trouble in answer["troubles"]]
    if not answer["commands"]:
        return said + ["no commands: the values that the filter ships with stay"]
    if not said:
        said = ["the model fits"]
    shipped = f"the values that {answer['filter']} ships with"
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
        raise TiltError(f"{stream.path}: all rows have one time, so that it has no rate")
    every = tunable(args.filter, rate_of(stream))
    answer = measured(stream, every, args.filter)
    print(json.dumps(answer, indent=1) if args.json else "\n".join(lines(answer)))
    return 1 if answer["troubles"] else 0
