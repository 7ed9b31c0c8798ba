"""The command of tools/design: what it refuses, in which words, and that the nearest value it names is the nearest: fed back it gives a design,
2 % further towards what was asked there is none. And filters at the edges that it tells of."""
import functools
import math
import pathlib
import random
import re
import sys
from fractions import Fraction

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import design_support
from design_support import BASE, said
from system_support import needs, run_all, test

needs("design", "matplotlib", "scipy")

from design import command, synthesis  # noqa: E402
from design.given import Wrong  # noqa: E402
from design.synthesis import Infeasible  # noqa: E402

refusal = functools.lru_cache(said)
PAIRS, ALONE, SEARCHED = 200, 40, 40  # of each so many-th is searched for
BEYOND = 0.02

# arguments, what the sentence names
REFUSED = (
    (["--sigma", "2", "--noise-gain", "0.6"], ("--rate", "--period")),
    (["--rate", "0", "--sigma", "2", "--noise-gain", "0.6"], ("--rate is 0", "above 0")),
    (["--rate", "100", "--sigma", "-1", "--noise-gain", "0.6"], ("--sigma is -1", "above 0", "nearest")),
    (["--rate", "100", "--sigma", "nan", "--noise-gain", "0.6"], ("--sigma is nan", "finite")),
    (["--rate", "100", "--sigma", "inf", "--noise-gain", "0.6"], ("--sigma is inf", "finite")),
    (["--rate", "100", "--noise-gain", "0.6"], ("--sigma", "--sigma-of")),
    (["--rate", "100", "--sigma-of", "no/such.csv", "--noise-gain", "0.3"], ("no/such.csv", "No such file")),
    (["--rate", "100", "--sigma-of", "README.md", "--noise-gain", "0.3"], ("README.md", "no columns x, y, z")),
    (BASE, ("give a bound", "--error")),
    ([*BASE, "--noise-gain", "0.4"], ("0.4", "(2, 1, 0)", "0.5000", "nearest: --noise-gain 0.50", "-l 1")),
    ([*BASE, "--noise-gain", "1.5"], ("needs no filter", "nearest: --noise-gain 0.999")),
    ([*BASE, "--noise-gain", "-1"], ("-1", "above 0", "nearest")),
    ([*BASE, "--noise-gain", "nan"], ("nan", "finite")),
    ([*BASE, "--error", "2"], ("--at", "acceleration")),
    ([*BASE, "--error", "inf", "--at", "100"], ("--error is inf", "finite")),
    ([*BASE, "--error", "0.01", "--at", "1000", "--noise-gain", "0.6"],
     ("both bounds", "least noise gain is", "least error is", "nearest: --noise-gain")),
    ([*BASE, "--a=-0.9", "--b", "0.1"], ("unstable", "1 + 2 a1 (1 - b0) = -0.62", "nearest: --a=-0.9 --b 0.44")),
    ([*BASE, "-k", "0", "--b", "0.1,-0.5"], ("unstable", "pole", "nearest: --b")),
    ([*BASE, "--a=-0.3,0.1", "-k", "1", "--b", "0.1"], ("--a has 2", "k = 1", "-k 2")),
    ([*BASE, "--a=nan", "--b", "0.1"], ("finite",)),
    ([*BASE, "-k", "1", "-l", "2", "--noise-gain", "0.3"], ("(2, 1, 2)", "sum a = -1", "astatism 3", "nearest")),
    ([*BASE, "-v", "0", "--noise-gain", "0.3"], ("(0, 0, 0)", "v must be 1 or more")),
    ([*BASE, "-v", "2", "-k", "0", "-l", "30", "--noise-gain", "0.3"], ("(2, 0, 30)", "at most 10")),
    ([*BASE, "-k", "0", "--noise-gain", "0.6", "--band", "b7=0..1"], ("--band b7", "has b0;")),
    ([*BASE, "-k", "0", "--noise-gain", "0.6", "--band", "b0=1..0.5"], ("ends before it begins",)),
    ([*BASE, "--noise-gain", "0.6", "--band", "b0"], ("NAME=LOW..HIGH",)),
    ([*BASE, "-k", "0", "--noise-gain", "0.6", "--band", "b0=0.5..1", "--band", "b0=0.6..1"], ("--band b0 is given twice",)),
    ([*BASE, "-k", "0", "-l", "1", "--region", "safe", "--noise-gain", "0.1"], ("(2, 0, 1) with b0 >= 0.5 can reach", "nearest: --noise-gain 0.34")),
    ([*BASE, "--noise-gain", "0.6", "--a=x"], ("'x' is not a list of numbers",)),
    ([*BASE, "-k", "0", "--noise-gain", "0.6", "--lsb-per-unit", "0"], ("--lsb-per-unit is 0",)),
    ([*BASE, "-k", "0", "--noise-gain", "0.6", "--band", "b0=0..1e400"], ("NAME=LOW..HIGH",)),
    ([*BASE, "--error", "1", "--at", "1", "--settle", "0"], ("--settle is 0", "above 0", "nearest: 0.01")),
    ([*BASE, "--error", "1", "--at", "1", "--settle", "0.001"], ("nothing settles within less than a sample", "nearest: 0.01")),
    (["--rate", "1e300", "--sigma", "1", "--error", "1", "--at", "1"], ("--rate is 1e+300", "within 1e-09..1e+09")),
    (["--rate", "10", "--sigma-of", "/bin/ls", "--b", "0.5"], ("/bin/ls: not text",)),
    (["--rate", "10", "--sigma", "1", "--b", "1e300"], ("unstable", "nearest: --a=0 --b 1")),
    (["--rate", "10", "--sigma", "1", "-v", "9", "--settle", "0.1", "--error", "1e-5", "--at", "1"],
     ("no stable filter", "settles in time", "nearest: --settle 0.")),
    ([*BASE, "--noise-gain", "inf"], ("inf", "finite", "nearest: --noise-gain 0.999")),
    ([*BASE, "--noise-gain", "inf", "--error", "1", "--at", "100"], ("inf", "finite", "nearest: --noise-gain 0.5")),
    ([*BASE, "--noise-gain", "nan", "--error", "1", "--at", "100"], ("nan", "finite", "nearest: --noise-gain 0.5")),
    ([*BASE, "--noise-gain", "0.4", "--error", "1", "--at", "100"], ("both bounds", "no filter with any error", "nearest: --noise-gain 0.5")),
    ([*BASE, "-k", "0", "-l", "1", "--noise-gain", "0.00001"], ("can be computed", "nearest: --noise-gain 0.0001")),
    ([*BASE, "-v", "9", "--noise-gain", "0.6"], ("(9, 0, 0)", "0.99998", "nearest: --noise-gain 0.99998")),
    ([*BASE, "-v", "5", "--noise-gain", "0.6"], ("(5, 0, 0)", "nearest: --noise-gain 0.99", "or -k 0 -l 4")),
    ([*BASE, "-v", "3"], ("give a bound", "nearest: --noise-gain 0.9")),
    ([*BASE, "--error", "1e9", "--at", "1"], ("--error is 1e+09", "1e-06 to 10000", "not 1e+13")),
    ([*BASE, "--error", "0", "--at", "1"], ("--error is 0", "above 0", "nearest: --error 1e-09")),
    ([*BASE, "--error", "1e-8", "--at", "1e6"], ("1e-10", "nearest: --error 0.0001")),
    ([*BASE, "-v", "9", "--error", "1", "--at", "1"], ("no error is", "nearest: --period 1")),
    ([*BASE, "--a=-1", "--noise-gain", "0.6"], ("the astatism exceeds 2", "nearest: -v 3 -k 0 -l 2")),
    ([*BASE, "--a=-1.5,0.5", "--noise-gain", "0.6"], ("the astatism exceeds 2", "nearest: -v 3 --a=-0.5 -l 2")),
    ([*BASE, "--a=-2", "--noise-gain", "0.95"], ("not above 0", "nearest: --a=-0.")),
    ([*BASE, "--b", "1e-8"], ("does not die out", "nearest: --a=0 --b 2")),
    ([*BASE, "--a=-2", "--b", "0.75"], ("unstable", "nearest: --a=-2 --b 0.75")),
    ([*BASE, "--a=0", "--b", "0"], ("must not be 0", "nearest: --b 0.99999")),
    ([*BASE, "--b", "0.5", "--noise-gain", "0.6"], ("--noise-gain with --b", "leave out --noise-gain, or --b")),
    ([*BASE, "--b", "0.5", "--error", "1", "--at", "100", "--settle", "1"], ("--error and --settle with --b",)),
    ([*BASE, "--b", "0.5", "--region", "safe"], ("--region with --b",)),
    ([*BASE, "--noise-gain", "0.6", "--as-printed"], ("--as-printed", "no --b")),
    ([*BASE, "--noise-gain", "0.6", "schedule", "--p0-over-r", "5"], ("schedule comes first", "design schedule --p0-over-r 5")),
    (["schedule", "--rate", "10"], ("unrecognized arguments: --rate 10",)),
)


@test
def what_cannot_be_is_refused_in_one_sentence():
    for arguments, words in REFUSED:
        status, out, error = refusal(*arguments)
        last = error.strip().splitlines()[-1] if error.strip() else ""
        assert status in (1, 2) and not out, (arguments, status, out[:100])
        assert last.startswith(("design: ", "design schedule: ")) and error.count("\n") == 1, (arguments, error)
        for word in words:
            assert word in last, f"{arguments}: '{word}' is not in: {last}"


def with_nearest(arguments, nearest):
    """The arguments with those in their place that a sentence names as nearest."""
    fixed = re.sub(r" instead of --a.*| \(.*|, or .*|;.*", "", nearest).split()
    names = {word.split("=")[0] for word in fixed if re.match(r"--?[a-z]", word)}
    names |= {"--a"} if "instead of --a" in nearest else set()
    names |= {"--rate"} if "--period" in names else set()
    kept, skip = [], False
    for word in arguments:
        if skip:
            skip = False
        elif word.split("=")[0] in names:
            skip = "=" not in word
        else:
            kept.append(word)
    return [*kept, *fixed]


def made(arguments):
    """True when there is a design: of a filter that is given the whole report, of others, whose report takes seconds, the synthesis."""
    options, _ = command.parser().parse_known_args(arguments)
    if options.b is not None:
        return said(*arguments)[0] == 0
    if options.error is None and (max(options.astatism, options.l or 0) > 3):
        return synthesis.reachable(command.checked(options).request, options.noise_gain)
    return outcome(arguments)[0] is not None


@test
def what_is_called_nearest_gives_a_design():
    told = 0
    for arguments, _ in REFUSED:
        _, _, error = refusal(*arguments)
        for one in error.strip().partition("nearest: ")[2].split(", or "):
            if not re.match(r"--?[a-z]", one) or "leave out" in error or one in ("--rate 100", "--sigma 2"):  # the first of two that are missing
                continue
            assert made(with_nearest(arguments, one)), (arguments, one)
            told += 1
    assert told >= 25, told


def outcome(arguments):
    """(filter, "") or (None, sentence) of the synthesis alone."""
    try:
        return command.synthesised(command.checked(command.parser().parse_args(arguments))), ""
    except (Wrong, Infeasible) as problem:
        return None, str(problem)


def holds(arguments):
    """True when there is a filter; when there is none, its sentence's nearest value is that one and 2 % beyond it is not."""
    f, sentence = outcome(arguments)
    if f is not None:
        return True
    found = re.search(r"nearest: (--noise-gain|--error) (\S+?)(?:,|$)", sentence)
    assert found, (arguments, sentence)
    name, near = found[1], float(found[2])
    asked = float(arguments[arguments.index(name) + 1])
    assert outcome(with_nearest(arguments, f"{name} {found[2]}"))[0] is not None, (arguments, sentence)
    beyond = min(near * (1 + BEYOND), asked) if asked > near else max(near * (1 - BEYOND), asked)
    assert outcome(with_nearest(arguments, f"{name} {beyond!r}"))[0] is None, (arguments, sentence, beyond)
    return False


def random_structure(chance, searched):
    """Of those with a formula, or of those that are searched, which takes a second."""
    return chance.choice(("-v 2", "-v 2 --region safe", "--a=-0.3") if searched else ("-v 1", "-k 0", "-k 0 -l 1")).split()


def order_of(words):
    return int(words[words.index("-v") + 1]) if "-v" in words else 2


@test
def random_pairs_of_bounds_hold_or_name_the_nearest():
    chance, seen = random.Random(10), [0, 0]
    for number in range(PAIRS):
        words, rate, at = random_structure(chance, number % SEARCHED == 0), chance.choice((10, 50, 100, 400)), 10 ** chance.uniform(0, 4)
        scale = at / rate ** order_of(words)
        low, high = max(synthesis.ERROR_MIN * scale, 2e-9), synthesis.ERROR_MAX * scale
        error = math.exp(chance.uniform(math.log(low), math.log(high)))
        noise = chance.choice((10 ** chance.uniform(-2.5, 0), chance.uniform(0.4, 1.2)))
        seen[holds([*words, "--rate", str(rate), "--sigma", "1", "--error", repr(error), "--at", repr(at), "--noise-gain", repr(noise)])] += 1
    assert min(seen) > PAIRS // 5, seen


@test
def single_bounds_hold_or_name_the_nearest():
    chance, seen = random.Random(11), [0, 0]
    for number in range(ALONE):
        words = random_structure(chance, number % SEARCHED == 0)
        at = 10 ** chance.uniform(0, 3)
        error = at / 50 ** order_of(words) * 10 ** chance.choice((chance.uniform(-9, -6), chance.uniform(-3, 3), chance.uniform(4, 7)))
        if error > 1e-9:
            seen[holds([*words, "--rate", "50", "--sigma", "1", "--error", repr(error), "--at", repr(at)])] += 1
        seen[holds([*words, "--rate", "50", "--sigma", "1", "--noise-gain", repr(chance.uniform(0.001, 1.3))])] += 1
    assert min(seen) > ALONE // 4, seen


@test
def a_looser_bound_on_the_error_is_never_refused():
    for words in (["-v", "5"], ["-v", "3", "-k", "0", "-l", "1", "--settle", "1"], ["--a=-0.99"]):
        gains = []
        for error in (1e-6, 1.0, synthesis.ERROR_MAX):
            f, sentence = outcome([*words, "--period", "1", "--sigma", "1", "--error", repr(error), "--at", "1"])
            assert f is not None, (words, error, sentence)
            gains.append(float(f.exact().noise_gain()))
        assert all(later <= earlier * 1.001 for earlier, later in zip(gains, gains[1:])), (words, gains)


@test
def filters_at_the_edges_are_told():
    """a, b, dynamic error, what the line of the others says."""
    for a, b, error, words in (("-2", "0.75005", -0.24995 / 0.75005, "negative dynamic error"), ("-1.5", "0.8", -0.125, "negative dynamic error"),
                               ("-1", "0.6", 0.0, "no dynamic error"), (None, "1", 0.0, "no dynamic error")):
        status, out, problem = said("--rate", "10", "--sigma", "1", "--no-pictures", *([f"--a={a}"] if a else []), "--b", b)
        assert status == 0 and not problem, (a, b, problem)
        others = [line for line in out.splitlines() if line.startswith("others")]
        assert len(others) == 1 and words in others[0], out
        told = re.search(r"^dynamic error +(\S+)", out, re.M)[1]
        assert abs(float(told) - error) < 1e-6, (a, b, told)
        way = re.search(r"during the transient at most (\S+) times that", out)
        assert (way is not None) == (error != 0) and (way is None or float(way[1]) >= 1), out
        nearest = re.search(r"^this: none: .*nearest: (.*)$", out, re.M)[1]
        status, out, problem = said(*with_nearest(["--rate", "10", "--sigma", "1", "--no-pictures", *([f"--a={a}"] if a else []), "--b", b], nearest))
        assert status == 0 and "static const filter_config_t" in out and "[SYNTH_B0_UQ16]" in out, (a, b, nearest, problem)


@test
def schedule_stands_first():
    status, out, _ = said("schedule", "--p0-over-r", "8.33")
    assert status == 0 and "limit" in out
    for place in (2, 4):
        words = [*BASE[:4][:place], "schedule", *BASE[place:4], "--p0-over-r", "8.33"]
        status, out, error = said(*words)
        assert status == 2 and not out and "schedule comes first" in error.splitlines()[-1], (words, error)
    status, _, error = said(*BASE, "--noise-gain", "0.6", "--json", str(design_support.OUT / "schedule"))
    assert status == 0, error


@test
def infeasible_pairs_name_values_that_hold():
    request = synthesis.Request(2, 1, 0)
    least = float(synthesis.least_noise(request, 1.0).noise_gain())
    status, _, error = said(*BASE, "--error", "0.01", "--at", "100", "--noise-gain", "0.55")
    assert status == 1 and abs(float(re.search(r"least noise gain is ([0-9.]+)", error)[1]) - least) < 1e-4, error
    told = float(re.search(r"least error is ([0-9.]+)", error)[1])
    f = synthesis.least_error(request, 0.55)
    assert abs(told - f.dynamic_error() * 0.01) < 1e-4 * told
    assert Fraction(f.b[0]) > 0 and design_support.impulse_sum(f, 3000) <= 0.55 + 1e-9


if __name__ == "__main__":
    sys.exit(run_all())
