"""Runs a flight through the navigation filter on an UNO, in its simulator or on the PC, and draws the errors with their sigmas.

STREAM is a flight (docs/navigation.md lists its columns; `tilt flight` simulates one); without it the 500 s of paper 003 are simulated. `make nav`
builds the image, `make navflash` writes it to a board. The simulator takes about as long as the flight, --board pc a second; a board gets each
record when it is due (--fast: as soon as it has room).

Status: 0 all records were accepted, or rejected with a reason; 1 something was lost, or the filter's covariance is not healthy; 2 a file, an option
or the board cannot be used.
"""
from tilt.errors import TiltError
from tilt.numbers import whole_option
from tilt.place import IN_WHEEL

NAME = "nav"
SUMMARY = "run a flight through the navigation filter (paper 003)"
REFUSALS_SHOWN = 10
PICTURES = (".png", ".svg", ".pdf")


def arguments(parser):
    parser.add_argument("stream", metavar="STREAM", nargs="?", help="flight (default: 500 s, simulated)")
    parser.add_argument("--board", default="sim", metavar="sim|pc|PORT", help="where the filter runs (default sim: the simulated UNO)")
    parser.add_argument("--states", type=whole_option, choices=(9, 12), default=12, help="states: 12 with the gyros' drift, or 9 (default 12)")
    parser.add_argument("--every", type=whole_option, default=10, metavar="N", help="read the state after every Nth IMU record (default 10)")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=N[,N...]", help="setting of the filter, overrides the file's")
    parser.add_argument("--fast", action="store_true", help="at a port: send records before they are due")
    parser.add_argument("-o", "--output", metavar="OUT.csv", help="file of states to write")
    parser.add_argument("--plot", metavar="FILE.png", help="picture to write (default if the truth is known: build/nav.png; from a wheel nav.png)")


def flight_of(args):
    from tilt.navigation import flight
    from tilt.progress import bar

    if args.stream is None:
        return flight.simulated(flight.Wish())
    with bar("reading", "B") as report:
        return flight.read(args.stream, report)


def ran(args, sent):
    from tilt.navigation import boards
    from tilt.progress import bar

    if IN_WHEEL and args.board in ("sim", "pc"):
        raise TiltError(f"--board {args.board} needs the sources of the navigation image: run it in a checkout, with make; a PORT works from here")

    with bar("filtering", "record") as report:
        if args.board == "sim":
            return boards.simulated(sent, args.states, report)
        if args.board == "pc":
            return boards.on_pc(sent, args.states, report)
        return boards.at_port(args.board, sent, args.states, args.fast, report)


def write(path, outcome):
    names = "q_w,q_x,q_y,q_z,v_n_mps,v_e_mps,v_d_mps,r_n_m,r_e_m,r_d_m,drift_x_rps,drift_y_rps,drift_z_rps"
    try:
        with open(path, "w", encoding="utf-8") as file:
            print(f"t_us,{names}", file=file)
            for state in outcome.states:
                print(state.t_us, *(f"{number:.9g}" for number in state.numbers), sep=",", file=file)
    except OSError as why:
        raise TiltError(f"{path}: {why.strerror}") from why
    print(f"{path}: {len(outcome.states)} states written")


def print_refusals(args, flight, sent, outcome):
    """Prints every record that was not simply accepted, with its place in the file; then the counts above zero."""
    from tilt.navigation import exchange, frames

    refused = exchange.refusals(sent, outcome)
    for record, answer in refused[:REFUSALS_SHOWN]:
        where = args.stream or "simulated flight"
        if record is not None and record.row is not None and flight.lines:
            where += f":{flight.lines[record.row]}"
        print(f"{where}: {record.kind if record else 'on the line'}: {frames.answer_text(answer.code)}")
    if len(refused) > REFUSALS_SHOWN:
        print(f"... and {len(refused) - REFUSALS_SHOWN} more")
    nonzero = ", ".join(f"{name} {count}" for name, count in outcome.counts.items() if count and name != "taken")
    print(f"board's counts: {nonzero or 'nothing refused'}")


def print_stats(stats):
    if stats:
        print(f"simulated UNO: load {100 * stats['cpu_load']:.1f} %, longest pass {stats['pass_max_cycles'] / 16000:.2f} ms, latest frame "
              f"{stats['frames_latest_us'] / 1000:.2f} ms, RAM with stack {stats['ram_used_bytes']} B, flash {stats['flash_bytes']} B")


def whole(sent, outcome):
    """Whether every record was answered and no answer was damaged."""
    if len(outcome.answers) != len(sent) or outcome.damaged or not outcome.counts:
        print(f"lost: {len(sent)} records sent, {len(outcome.answers)} answered, {outcome.damaged} damaged records from the board")
        return False
    return True


def check_files(args, flight):
    """TiltError before the flight if an output could not be written after it."""
    import pathlib

    for path in filter(None, (args.output, args.plot)):
        if not pathlib.Path(path).parent.is_dir():
            raise TiltError(f"{path}: no folder {pathlib.Path(path).parent}")
    if args.plot and pathlib.Path(args.plot).suffix.lower() not in PICTURES:
        raise TiltError(f"--plot {args.plot}: unknown suffix: use one of {' '.join(PICTURES)}")
    if args.plot and not flight.truth:
        raise TiltError(f"--plot draws errors, but {args.stream} has no truth")


def show(args, flight, outcome):
    from tilt.navigation import judge

    found = judge.errors(flight, outcome)
    if found is None or not len(found.t_s):
        if args.plot:
            raise TiltError(f"--plot draws errors, but {args.stream} has no truth at the times of the states")
        return
    print("\n".join(judge.table(flight, found)))
    from tilt.navigation import boards, picture

    path = args.plot or ("nav.png" if IN_WHEEL else boards.ROOT / "build/nav.png")
    what = {"sim": "in the simulated UNO", "pc": "on the PC"}.get(args.board, f"on the board at {args.board}")
    picture.draw(path, f"{args.states} states {what}, {flight.seconds:.0f} s", flight, found, outcome)
    print(f"{path}: written")


def run(args):
    from tilt.navigation import exchange, settings

    if args.every < 1:
        raise TiltError(f"--every {args.every}: give 1 or more")
    chosen = dict(settings.of_option(text) for text in args.set)
    flight = flight_of(args)
    check_files(args, flight)
    sent = exchange.records(flight, chosen, args.every)
    done = ran(args, sent)
    print(f"{flight.seconds:.1f} s of flight in {done.took_s:.1f} s: {len(sent)} records, {len(done.outcome.states)} states")
    exchange.check_start(sent, done.outcome)
    print_stats(done.stats)
    print_refusals(args, flight, sent, done.outcome)
    complete = whole(sent, done.outcome)
    show(args, flight, done.outcome)
    if args.output:
        write(args.output, done.outcome)
    if not done.outcome.healthy:
        print("the filter's covariance or state is not healthy")
    return 0 if complete and done.outcome.healthy else 1
