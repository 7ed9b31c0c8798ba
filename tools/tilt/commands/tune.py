"""Fits a filter's parameters to a recording, and prints the commands that set them on the board, in the order in which to type them.

The values are those with the least distance from the recording smoothed without lag, as the shipped code runs them. They are printed only if
values from the rest of the recording serve each part of it too; otherwise the defaults stay, and the output says why. The board measures the
sensor's noise itself. --apply resets the board, types the commands and reads the answers; `save` then keeps them.

Status: 0 done, also where the defaults stay; 1 with --apply: the board refused or did not answer; 2 a file, an option or the port cannot be used.
"""
import itertools
import json
import time

from tilt import protocol
from tilt.errors import TiltError
from tilt.numbers import real_option, whole_option

NAME = "tune"
SUMMARY = "fit a filter's parameters to a recording"
HEADER_S, ANSWER_S = 4.0, 5.0  # a reset board sends its header within 3 s; one that has no reset line never does


def arguments(parser):
    parser.add_argument("stream", metavar="STREAM", help="recording (docs/protocol.md, Streams): the motion you mean, 15 s of it or more")
    parser.add_argument("--filter", metavar="NAME", help="which filter (default: the one that the firmware starts with)")
    parser.add_argument("--rate", metavar="HZ", type=real_option, help="output data rate of the board (default: nearest to the recording's)")
    parser.add_argument("--apply", metavar="PORT", help="type the commands into the board at this port")
    parser.add_argument("--baud", type=whole_option, default=protocol.BAUD_AT_START, metavar="N",
                        help=f"baud rate of --apply (default {protocol.BAUD_AT_START})")
    parser.add_argument("--json", action="store_true", help="print all results as one JSON object")


def measured(stream, name, rate_dhz):
    """The whole result, as --json prints it."""
    import numpy as np
    from tilt import fitting, native
    from tilt.progress import bar

    samples = fitting.samples_of(stream, rate_dhz)
    with bar("parameters", "round") as report:
        fit = fitting.fitted(samples, name, report)
    values = typed_in_order(name, rate_dhz, fit.values)
    if values is None:
        fit.values, values, fit.fitted_lsb, fit.reason = {}, [], fit.default_lsb, "no order in which the board would accept the better values"
    noise = None if samples.rest.r_lsb2 is None else np.sqrt(samples.rest.r_lsb2).tolist()
    return {"stream": stream.path, "filter": name, "rate_hz": rate_dhz / 10, "motion_seconds": samples.motion_s,
            "rest_seconds": samples.rest.seconds, "noise_lsb": noise, "default_lsb": fit.default_lsb, "fitted_lsb": fit.fitted_lsb,
            "held_back": fit.held_back, "values": fit.values, "reason": fit.reason, "flash": native.flashed_by(name),
            "commands": [f"filter {name}", f"rate {rate_dhz / 10:g}", *values] if values else []}


def typed_in_order(name, rate_dhz, values):
    """`NAME VALUE` of each, in an order in which the filter accepts every one, or None; values that depend on each other have few."""
    from tilt import native

    every = native.parameters(name, rate_dhz)
    for order in itertools.permutations(values):
        if all(native.accepts(name, rate_dhz, {key: values[key] for key in order[:count]}) for count in range(1, len(order) + 1)):
            return [f"{key} {every[key].text(values[key])}" for key in order]
    return None


def percent(part):
    """'+1.2 %' of a quotient; zero has no minus sign."""
    return f"{round(100.0 * (part - 1.0), 1) + 0.0:+.1f} %"


def lines(answer):
    noise = answer["noise_lsb"]
    at_rest = f"noise {' '.join(f'{axis:.2f}' for axis in noise)} LSB rms (x y z)" if noise else "no stretch at rest, so the noise is unknown"
    said = [f"{answer['stream']}: sensor at {answer['rate_hz']:g} Hz, {answer['motion_seconds']:.1f} s of motion, "
            f"{answer['rest_seconds']:.1f} s at rest: {at_rest}; the board measures it itself"]
    if not answer["commands"]:
        return said + [f"keep the defaults of {answer['filter']}: {answer['reason']}"]
    return said + [f"{answer['filter']}: {answer['default_lsb']:.2f} LSB rms from the smoothed recording with the defaults, "
                   f"{answer['fitted_lsb']:.2f} ({percent(answer['fitted_lsb'] / answer['default_lsb'])}) with these values",
                   f"values chosen by three quarters of the recording change the fourth by {percent(answer['held_back'])}",
                   f"flash: {answer['flash']}", "", *answer["commands"]]


def apply(name, baud, commands, say):
    """Resets the board, types the commands and prints the answers by say. Returns ({command: answer or None}, what went wrong); TiltError if the
    port cannot be opened."""
    from tilt.port import Gone, Port

    port, answers, failed = Port(name, baud), {}, []
    port.open()
    try:
        line_that(protocol.is_header, port, HEADER_S)  # before it the boot loader takes what is typed
        for command in commands:
            port.send(command)
            answers[command] = answer = line_that(lambda said, command=command: protocol.answers(command, said), port, ANSWER_S)
            say(f"{command}: {answer or f'no answer at {baud} baud: give --baud N if the board has another rate'}")
            if answer is None or answer.startswith(protocol.REFUSED):
                failed.append(command)
                break  # the values belong together
    except Gone:
        failed.append("the port is gone")
    finally:
        port.close()
    return answers, failed


def line_that(wanted, port, wait_s):
    """The board's next such line, without a cut row before its #; None if none comes."""
    text, end = b"", time.monotonic() + wait_s
    while time.monotonic() < end:
        *whole, text = (text + port.read()).split(b"\n")
        for line in whole:
            said = line[max(line.find(b"#"), 0):].decode("latin-1").strip()
            if wanted(said):
                return said
    return None


def run(args):
    from tilt import Stream, native

    name = args.filter or native.filters()[0]
    if native.chosen(name) != [name]:
        raise TiltError(f"--filter {name}: give one filter")
    protocol.check_baud(args.baud)
    stream = Stream.read(args.stream)
    answer, failed, say = measured(stream, name, native.rate_of(stream, args.rate)), [], (lambda text: None) if args.json else print
    say("\n".join(lines(answer)))
    if args.apply:
        answer["answers"], failed = apply(args.apply, args.baud, answer["commands"], say) if answer["commands"] else ({}, [])
        say(f"not set: {', '.join(failed)}" if failed else "set; type save to keep them" if answer["commands"] else
            "nothing typed: the board keeps the values that it has")
    if args.json:
        print(json.dumps(answer, indent=1))
    return 1 if failed else 0
