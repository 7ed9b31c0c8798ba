"""The command line of the synthesiser."""
import argparse
import dataclasses
import importlib
import json
import math
import pathlib
import sys
from fractions import Fraction

from tilt.options import Parser

from . import configuration, nearest, pictures, report, switching
from .given import Wrong, given_filter
from .measure import sigma_of_stream
from .response import Endless
from .structure import Filter
from .synthesis import (ERROR_MAX, ERROR_MIN, LEAST_SHAPE, REGIONS, Infeasible, NoneFound, Request, check_order, least_error, least_noise,
                        nearest_noise, ordinal, rounded)
from .typed import typed

EPILOG = """
the structure, in the papers' letters
  A(z) = (1 - z^-1)^v (1 + a1 z^-1 + ... + ak z^-k)    v: order of astatism, one more than the order of the polynomial in time that is
                                                       tracked without error (v = 2: straight lines); k: order of what raises it towards v + 1
  B(z) = b0 + b1 z^-1 + ... + bl z^-l                  l: order of B, the smoothing coefficients
  x_e = [1 - A] x^ + b1 u(n-1) + ... + bl u(n-l);  u = g - x_e;  x^ = x_e + b0 u;  x^ / g = B / C,  C = B + (1 - b0) A
  (2, 1, 0) is the papers' filter and `synth`; (2, 0, 1) alpha-beta; (3, 0, 2) alpha-beta-gamma; (2, 1, 2) with --a=-rho Singer's steady filter

the dynamic error is the steady error under a constant derivative of order v: rate (v = 1), acceleration (2), jerk (3); in samples it is
  D = (1 - b0) (1 + sum a) / sum b  per v-th difference, and error = D x derivative x period^v

examples
  python tools/design --rate 10 --sigma 3.4 --error 3 --at 100                  least noise for 3 LSB of error at 100 LSB/s2
  python tools/design --rate 100 --sigma 2 --noise-gain 0.3 -k 0 -l 1           least error for a noise gain of 0.3, alpha-beta
  python tools/design --rate 10 --sigma 0.5 --unit m -k 1 -l 0 --a=-0.3 --b 0.1   properties of paper 001's filter
  python tools/design --rate 100 --sigma-of sim/streams/rest-2lsb.csv --error 2 --at 500 --json build/design/design.json
  python tools/design schedule --p0-over-r 8.33                                 gains of a start, off line; `schedule` comes first
"""


def numbers_list(text):
    try:
        return tuple(float(x) for x in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is not a list of numbers separated by commas") from None


def band_range(text):
    name, _, limits = text.partition("=")
    low, _, high = limits.partition("..")
    try:
        return name, (float(Fraction(low)), float(Fraction(high)))
    except (ValueError, ZeroDivisionError, OverflowError):
        raise argparse.ArgumentTypeError(f"'{text}' is not NAME=LOW..HIGH, such as b0=0.5..1") from None


def parser():
    words = Parser(prog="design", epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter,
                   description="Structural and parametric synthesis of a polynomial smoothing filter (papers 000 and 001).")
    words.add_argument("-v", "--astatism", type=int, default=2, metavar="V", help="order of astatism (2)")
    words.add_argument("-k", type=int, default=None, help="order of A's factor (1; with --a: as many as given)")
    words.add_argument("-l", type=int, default=None, help="order of B (0; with --b: one less than given)")
    words.add_argument("--rate", type=float, metavar="HZ", help="samples per second")
    words.add_argument("--period", type=float, metavar="S", help="or: seconds per sample")
    words.add_argument("--sigma", type=float, help="standard deviation of the measurement noise, in --unit")
    words.add_argument("--sigma-of", metavar="FILE", help="or: a recorded stream to measure it from (LSB; the largest of x, y, z)")
    words.add_argument("--error", type=float, help="bound: dynamic error, in --unit")
    words.add_argument("--at", type=float, help="... under this rate (v = 1), acceleration (2), jerk (3), in unit / s^v")
    words.add_argument("--noise-gain", type=float, help="bound: variance of the estimate's error over that of the noise")
    words.add_argument("--a", type=numbers_list, help="fix a1,a2,... (--a=-0.3)")
    words.add_argument("--b", type=numbers_list, help="with --a: analyse this filter instead of a synthesis")
    words.add_argument("--as-printed", action="store_true", help="with --b b0,b1,..: past innovations as in paper 001 (17), not in x_e")
    words.add_argument("--region", choices=sorted(REGIONS), default=None,
                       help="paper: -1 <= sum a <= 0 (default); exact: any stable filter; safe: a1 in [-1/3, 0], b0 >= 1/2")
    words.add_argument("--settle", type=float, metavar="S", help="bound: the slowest pole decays to 2 %% within S seconds")
    words.add_argument("--band", type=band_range, action="append", default=[], metavar="NAME=LOW..HIGH",
                       help="range over which a parameter is switched, for the verdict (default: b0 from its value to 1, a from its value to 0)")
    words.add_argument("--unit", default="LSB", help="name of the unit (default LSB)")
    words.add_argument("--lsb-per-unit", type=float, help="for the configuration: LSB (256 per g) per unit; 1 for LSB")
    words.add_argument("--out", default="build/design", metavar="FOLDER", help="folder for design.png and design.svg (default build/design)")
    words.add_argument("--no-pictures", action="store_true")
    words.add_argument("--json", metavar="FILE", help="also write the results as JSON")
    return words


SMALLEST, LARGEST = 1e-9, 1e9  # range of sensible input, within which nothing overflows
AT_THE_END = 1e-9  # relative rounding allowed for a bound at either end


def finite_positive(value, name, least=0.001):
    if not math.isfinite(value) or value <= 0:
        raise Wrong(f"{name} is {value:g}, but must be finite and above 0; nearest: {least:g}")
    if not SMALLEST <= value <= LARGEST:
        raise Wrong(f"{name} is {value:g}, but must be within {SMALLEST:g}..{LARGEST:g}; nearest: {SMALLEST if value < 1 else LARGEST:g}")
    return value


@dataclasses.dataclass
class Task:
    """A checked request: the structure, the sampling, the bounds in samples."""

    request: Request
    period_s: float
    sigma: float
    error_max: float  # D, None: no bound
    noise_max: float
    scale: float  # error in units for D = 1, None if no derivative is given
    at_text: str


def checked(options):
    if (options.rate is None) == (options.period is None):
        raise Wrong("give the sampling by either --rate HZ or --period S; nearest: --rate 100")
    period_s = finite_positive(options.period, "--period") if options.rate is None else 1 / finite_positive(options.rate, "--rate")
    if (options.sigma is None) == (options.sigma_of is None):
        raise Wrong("give the noise by either --sigma or --sigma-of FILE; nearest: --sigma 2")
    sigma = options.sigma if options.sigma is not None else sigma_of_stream(options.sigma_of)
    finite_positive(sigma, "--sigma")
    v = options.astatism
    k = options.k if options.k is not None else (len(options.a) if options.a is not None else (1 if v == 2 and not options.l else 0))
    l = options.l if options.l is not None else (len(options.b) - 1 if options.b is not None else 0)  # noqa: E741
    check_order(v, k, l)
    if options.b is not None:
        beside = [f"--{name.replace('_', '-')}" for name in ("error", "noise_gain", "settle", "region") if getattr(options, name) is not None]
        if beside:
            raise Wrong(f"{' and '.join(beside)} with --b: bounds apply to a synthesis, not to a given filter; "
                        f"nearest: leave out {' and '.join(beside)}, or --b")
    elif options.as_printed:
        raise Wrong("--as-printed interprets --b, but there is no --b; nearest: leave it out")
    scale, at_text = None, ""
    if options.error is not None and options.at is None:
        raise Wrong(f"--error needs --at, the {order_word(v)} under which it holds; nearest: --at 100")
    if options.at is not None:
        scale = finite_positive(options.at, "--at") * period_s ** v
        at_text = f"under {article(v)} {order_word(v)} of {options.at:g} {options.unit}/s{v if v > 1 else ''}"
    error_max = error_bound(options.error, scale, v) if options.error is not None else None
    slowest = None
    if options.settle is not None:
        if finite_positive(options.settle, "--settle", period_s) < period_s:
            raise Wrong(f"--settle is {options.settle:g} s, but nothing settles within less than a sample; nearest: {period_s:g}")
        slowest = 0.02 ** (period_s / options.settle)
    request = Request(v, k, l, REGIONS[options.region or "paper"], options.a, slowest)
    return Task(request, period_s, sigma, error_max, options.noise_gain, scale, at_text)


def error_bound(error, scale, v):
    """The bound per v-th difference; Wrong, with the nearest possible one, if it is out of range."""
    low, high = max(ERROR_MIN * scale, SMALLEST), min(ERROR_MAX * scale, LARGEST)
    low, high = low * (1 - AT_THE_END), high * (1 + AT_THE_END)
    if math.isfinite(error) and low <= error <= high:
        return error / scale
    if low > high:
        raise Wrong(f"--error is {error:g}, but at this rate and --at no error is within {ERROR_MIN:g} to {ERROR_MAX:g} per {ordinal(v)} difference; "
                    f"nearest: {'--period 1' if high < SMALLEST else '--period 0.001'}")
    why = "must be finite and above 0" if not (math.isfinite(error) and error > 0) else \
        f"must be {ERROR_MIN:g} to {ERROR_MAX:g} per {ordinal(v)} difference, not {error / scale:.4g}"
    raise Wrong(f"--error is {error:g}, but {why}; nearest: --error {rounded(low) if not error > low else rounded(high, up=False):.12g}")


def order_word(v):
    return {1: "rate", 2: "acceleration", 3: "jerk"}.get(v, f"{ordinal(v)} derivative")


def article(v):
    return "an" if v == 2 else "a"


def synthesised(task):
    """The filter that meets the bounds."""
    request, noise_max = task.request, task.noise_max
    if task.error_max is None and noise_max is None:
        raise Wrong("give a bound: --error E --at A, or --noise-gain N (or --a and --b to analyse a filter); "
                    f"nearest: {nearest_noise(request, 0.6)}")
    if request.fixed_a is not None and len(request.fixed_a) == request.k and 1 + sum(request.fixed_a) < LEAST_SHAPE:
        raise Wrong(f"with a1 + ... + ak = {sum(request.fixed_a):g} the dynamic error is not above 0 (at -1 the astatism exceeds {request.v}); "
                    f"nearest: {nearest.with_error(request, noise_max)}")
    if task.error_max is None:
        return least_error(request, noise_max)
    try:
        f = least_noise(request, task.error_max)
    except NoneFound as problem:
        raise Wrong(f"{problem}; nearest: {nearest.settle(request, task.error_max, task.period_s)}") from None
    if noise_max is None or (math.isfinite(noise_max) and f.noise_gain() <= noise_max):
        return f
    raise Wrong(both_bounds(task, f))


def both_bounds(task, f):
    """The message for a noise gain and an error that exclude each other."""
    asked, least = task.noise_max, f.noise_gain()
    near = f"nearest: --noise-gain {rounded(least):.12g}"
    if not (math.isfinite(asked) and asked > 0):
        return f"a noise gain of {asked:g} is impossible: it must be finite and above 0; {near}"
    try:
        error = f"the least error is {least_error(task.request, asked).dynamic_error() * task.scale:.4g}, not {task.error_max * task.scale:.4g}"
    except Infeasible:
        error = "there is no filter with any error"
    return (f"{task.request.name} cannot meet both bounds: with that error the least noise gain is {least:.6g}, not {asked:g}, and "
            f"with that noise gain {error}; {near}")


def alternatives(task, f):
    """Other structures under the same bound: (name, filter or sentence)."""
    v = task.request.v
    error = task.error_max if task.error_max is not None or task.noise_max is not None else f.dynamic_error()
    if error is not None and not error > 0:
        kind = "negative" if error < 0 else "no"
        return [("others", f"none: this filter has {kind} dynamic error, so no structure has the same")]
    wanted = [(f"(v, k, l) = ({v}, 0, 0)", (v, 0, 0)), (f"(v, k, l) = ({v}, 0, {v - 1})", (v, 0, v - 1))]
    if v == 2:
        wanted = [("(2, 1, 0), a1 <= 0 (synth)", (2, 1, 0)), ("(2, 0, 1) alpha-beta", (2, 0, 1))]
    found = []
    for name, order in wanted:
        if order == f.order and task.request.region.name == "paper":
            continue
        try:
            plain = Request(*order)
            found.append((name, least_noise(plain, error) if error is not None else least_error(plain, task.noise_max)))
        except Infeasible as problem:
            found.append((name, f"none: {problem}"))
    if v in (2, 3):
        name = f"({v}, 0, {v - 1}) steady Kalman ({configuration.KALMAN[v][0]})"
        try:
            found.append((name, configuration.kalman_for(v, error, None if error is not None else task.noise_max)))
        except configuration.Unfit as problem:
            found.append((name, f"none: {problem}"))
    return found


def default_band(f, ranges):
    known = dict(ranges)
    if len(known) < len(ranges):
        twice = next(name for i, (name, _) in enumerate(ranges) if name in dict(ranges[:i]))
        raise Wrong(f"--band {twice} is given twice; nearest: one of the two")
    names = [f"a{i + 1}" for i in range(f.k)] + [f"b{j}" for j in range(f.l + 1)]
    strange = sorted(set(known) - set(names))
    if strange:
        raise Wrong(f"--band {strange[0]}: this filter has {', '.join(names)}; nearest: --band b0=0.5..1")
    for name, (low, high) in known.items():
        if not low <= high:
            raise Wrong(f"--band {name}={low:g}..{high:g} ends before it begins; nearest: {name}={high:g}..{low:g}")
    a = tuple(known.get(f"a{i + 1}", (min(float(x), 0.0), max(float(x), 0.0))) for i, x in enumerate(f.a))
    b = tuple(known.get(f"b{j}", (float(x), max(float(x), 1.0)) if j == 0 else (float(x), float(x))) for j, x in enumerate(f.b))
    return switching.Band(f.v, a, b)


def configured(name, f, task, lsb_per_unit, fixed_a):
    """(lines, JSON) of the library's configuration."""
    rate_hz = round(1 / task.period_s, 9)
    try:
        noise_max = task.noise_max if task.error_max is None else None
        made = configuration.configure(f, rate_hz, task.sigma * lsb_per_unit, task.error_max, noise_max, fixed_a)
    except configuration.Unfit as problem:
        return [f"{name}: none: {problem}"], {"structure": name, "none": str(problem)}, None
    noise, error = float(made.filter.noise_gain()), float(made.filter.dynamic_error())
    on_board = typed(made, rate_hz, task.error_max, noise_max)
    lines = on_board.lines if on_board else []
    notes = configuration.notes_of(made, rate_hz, lines) + made.notes
    text = [f"{name}:", f"    {made.initialiser()}",
            f"    as stored: {report_parameters(made)}; noise gain {noise:.7f}, dynamic error {error:.7g} per "
            f"{ordinal(made.filter.v)} difference" + (f" = {error * task.scale:.5g}" if task.scale else "")]
    text += [f"    type: {line}" for line in lines] + differs(made, on_board) + [f"    note: {line}" for line in notes]
    return text, {"structure": name, "filter": made.name, "fields": made.fields, "initialiser": made.initialiser(), "noise_gain": noise,
                  "dynamic_error": error, "a": [float(x) for x in made.filter.a], "b": [float(x) for x in made.filter.b],
                  "commands": lines, "notes": notes}, made


def differs(made, on_board):
    """The line about what the typed values make, if it is another filter."""
    if on_board is None or on_board.filter == made.filter:
        return []
    f = on_board.filter
    return [f"    as typed, in four decimals: noise gain {float(f.noise_gain()):.7f}, dynamic error {float(f.dynamic_error()):.7g} per "
            f"{ordinal(f.v)} difference"]


def limit_of_schedule(f, task, lsb_per_unit):
    """The lines about the schedule whose limit is this filter, if there is one."""
    try:
        made = configuration.stored_opt(f, configuration.common_fields(round(1 / task.period_s, 9), task.sigma * lsb_per_unit))
    except configuration.Unfit:
        return [], []
    text = [f"also the limit of a schedule, with its quick start: {made.name}:", f"    {made.initialiser()}"]
    return text + [f"    note: {x}" for x in made.notes], [
        {"structure": "limit of a schedule", "filter": made.name, "fields": made.fields, "initialiser": made.initialiser(),
         "noise_gain": float(made.filter.noise_gain()), "dynamic_error": float(made.filter.dynamic_error()), "commands": [], "notes": made.notes}]


def report_parameters(made):
    f = made.filter
    return ", ".join([f"a{i + 1} = {float(x):.7f}" for i, x in enumerate(f.a)] + [f"b{j} = {float(x):.7f}" for j, x in enumerate(f.b)])


def design(options):
    task = checked(options)
    analysed = options.b is not None
    f = given_filter(options, task.request) if analysed else synthesised(task)
    f = Filter(f.v, tuple(float(x) + 0.0 for x in f.a), tuple(float(x) + 0.0 for x in f.b))
    one = report.facts(f)
    rows = alternatives(task, f)
    compared = [("this", one)] + [(name, g if isinstance(g, str) else report.facts(g)) for name, g in rows]
    band = default_band(f, options.band)
    verdict = switching.bounds(band)
    lsb_per_unit = options.lsb_per_unit if options.lsb_per_unit is not None else 1.0
    finite_positive(lsb_per_unit, "--lsb-per-unit")
    unitless = options.unit != "LSB" and options.lsb_per_unit is None
    text = [f"(v, k, l) = ({f.v}, {f.k}, {f.l}), {1 / task.period_s:g} Hz, sigma {task.sigma:.4g} {options.unit}; "
            f"{what_was_asked(task, options, analysed)}", "",
            f"A(z)            {report.factored_text(f)}", f"B(z)            {report.polynomial_text(f.b)}",
            f"closed loop     B / C, C(z) = {report.polynomial_text(f.characteristic)}", f"algorithm       {report.algorithm_text(f)}"]
    text += report.facts_text(one, task.period_s, task.sigma, options.unit, task.scale, task.at_text) + report.switching_text(band, verdict)
    text += ["", "side by side" + ("" if not analysed else ", each with the same dynamic error")]
    text += report.comparison_text(compared, task.period_s, task.scale, options.unit)
    text += ["", "configuration" + (f" (assumes 1 {options.unit} = 1 LSB: give --lsb-per-unit)" if unitless else "")]
    entries = []
    for name, g in [("this", f)] + [(name, g) for name, g in rows if not isinstance(g, str)]:
        lines, entry, _ = configured(name, g, task, lsb_per_unit, options.a is not None and g is f)
        text += lines
        entries.append(entry)
        if g is f and f.v == 2 and f.k <= 1 and f.l == 0:
            lines, more = limit_of_schedule(f, task, lsb_per_unit)
            text += lines
            entries += more
    drawn = []
    if not options.no_pictures:
        shown = [(f"this ({f.v}, {f.k}, {f.l})", f)] + [(name, g) for name, g in rows if not isinstance(g, str)]
        limit = options.error if options.error is not None else None
        title = f"(v, k, l) = ({f.v}, {f.k}, {f.l}) at {1 / task.period_s:g} Hz: {parameters_short(f)}, noise gain {one.noise_gain:.4f}"
        drawn = pictures.draw(options.out, title, shown, task.period_s, task.scale or 1.0, limit, options.unit if task.scale else "per difference")
        text += ["", "pictures        " + " ".join(str(path) for path in drawn)]
    result = {"order": f.order, "period_s": task.period_s, "sigma": task.sigma, "unit": options.unit, "design": dataclasses.asdict(one),
              "alternatives": [{"name": name, **({"none": x} if isinstance(x, str) else dataclasses.asdict(x))} for name, x in compared[1:]],
              "switching": {"band": band.text(), "low": verdict.low, "high": verdict.high, "verdict": verdict.verdict, "depth": verdict.depth},
              "configurations": entries, "pictures": [str(path) for path in drawn]}
    return text, result


def parameters_short(f):
    return ", ".join([f"a{i + 1} = {x:.4g}" for i, x in enumerate(f.a)] + [f"b{j} = {x:.4g}" for j, x in enumerate(f.b)])


def what_was_asked(task, options, analysed):
    if analysed:
        return "as given"
    bounds = []
    if task.error_max is not None:
        bounds.append(f"dynamic error <= {options.error:g} {options.unit} {task.at_text}, D <= {task.error_max:.6g}: least noise")
    if task.noise_max is not None:
        bounds.append(f"noise gain <= {task.noise_max:g}" + (": least dynamic error" if task.error_max is None else ""))
    return "; ".join(bounds) + task.request.limits


def main(arguments):
    if arguments[:1] == ["schedule"]:
        return importlib.import_module(".schedule", __package__).main(arguments[1:])
    reader = parser()
    options, strange = reader.parse_known_args(arguments)
    if strange:
        reader.error(f"schedule comes first and takes no option of the synthesis: python tools/design schedule {' '.join(strange[1:])}".strip()
                     if strange[0] == "schedule" else f"unrecognized arguments: {' '.join(strange)}")
    try:
        text, result = design(options)
        if options.json:
            path = pathlib.Path(options.json)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    except (Wrong, Infeasible, Endless) as problem:
        print(f"design: {problem}", file=sys.stderr)
        return 1
    except OSError as problem:
        print(f"design: {problem.filename or ''}: {problem.strerror}", file=sys.stderr)
        return 1
    except UnicodeDecodeError:
        print(f"design: {options.sigma_of}: not text, so not a stream", file=sys.stderr)
        return 1
    except ArithmeticError as problem:
        print(f"design: the numbers are beyond what can be computed ({problem}); nearest: values between 0.001 and 1000", file=sys.stderr)
        return 1
    try:
        print("\n".join(text), flush=True)
    except BrokenPipeError:  # the reader closed the pipe
        sys.stdout = None
    return 0
