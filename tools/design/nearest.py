"""The nearest possible request, in the command's words, if the given one is impossible; test_design_refusals.py feeds it back."""
import dataclasses
import math

from .response import Endless, horizon
from .synthesis import ORDER_MAX, Infeasible, NoneFound, least_noise, reachable, rounded

HALVINGS = 60
SUMS = (-0.999, -0.9, -0.6, -0.3)  # of a, tried in turn if the given one leaves no dynamic error
SETTLES = 40  # steps between settling times too short and certainly long enough


def numbers(values):
    return ",".join(f"{x:.6g}" for x in values)


def words(a, b):
    return f"--a={','.join(f'{x:.12g}' for x in a)} --b {numbers(b)}" if a else f"--b {numbers(b)}"


def raw(l):  # noqa: E741
    """b of almost the raw measurement, stable for any a and defined in the printed form too."""
    return (0.99999, *(0.0,) * l)


def usable(f):
    """Whether the filter is stable and its response short enough."""
    return f.exact().stable() and ends(f)


def ends(f):
    """Whether the response dies out soon enough to be computed."""
    try:
        horizon(f)
    except Endless:
        return False
    return True


def on_the_way(made, a, b):
    """On the way from B to the certainly valid B = 1: the first valid filter, rounded to the inside. `made` makes the filter of b0..bl."""

    def at(share):
        return [(1 - share) * x + (share if j == 0 else 0.0) for j, x in enumerate(b)]

    low, high = 0.0, 1.0 if len(b) == 1 else 1 - 1e-9
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if usable(made(at(middle))):
            high = middle
        else:
            low = middle
    for digits in range(4, 10):
        share = math.ceil(high * 10 ** digits + 1e-9) / 10 ** digits
        as_typed = [float(x) for x in numbers(at(share)).split(",")]
        if usable(made(as_typed)) and abs(as_typed[0] - at(high)[0]) <= 0.01 * abs(as_typed[0]):
            return words(a, as_typed)
    return words(a, raw(len(b) - 1))


def settle(request, error_max, period_s):
    """The shortest settling time for which the error has a filter; with 2 % less there is none."""

    def found(seconds):
        try:
            least_noise(dataclasses.replace(request, slowest=0.02 ** (period_s / seconds)), error_max)
        except NoneFound:
            return False
        return True

    low = math.log(period_s) + math.log(math.log(0.02) / math.log(request.slowest))
    high = low
    for _ in range(SETTLES):
        high += 0.5
        if found(math.exp(high)):
            break
    else:
        return "none; choose another structure"
    while high - low > 0.005:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if found(math.exp(middle)) else (middle, high)
    return f"--settle {rounded(math.exp(high)):.12g}"


def with_error(request, noise_max):
    """A replacement for an a whose sum is -1 or less: the filter of higher astatism that it represents, or a similar a."""
    whole, k, v = sum(request.fixed_a), request.k, request.v + 1
    if abs(1 + whole) < 1e-6 and v + k - 1 + v - 1 <= ORDER_MAX:  # 1 + a1 z^-1 + ... has the factor 1 - z^-1
        left, quotient = 1.0, []
        for x in request.fixed_a[:-1]:
            left += x
            quotient.append(left)
        other = dataclasses.replace(request, v=v, k=k - 1, l=v - 1, fixed_a=tuple(quotient))
        if noise_max is None or good_noise(other, noise_max):
            shape = f"--a={','.join(f'{x:.12g}' for x in quotient)}" if quotient else "-k 0"
            return f"-v {v} {shape} -l {v - 1} instead of --a"
    for least in SUMS:
        a = tuple(x * least / whole for x in request.fixed_a)
        if noise_max is None or good_noise(dataclasses.replace(request, fixed_a=a), noise_max):
            return f"--a={','.join(f'{x:.12g}' for x in a)}"
    return "leave out --a"


def good_noise(request, noise_max):
    try:
        return 0 < noise_max < 1 and reachable(request, noise_max)
    except Infeasible:
        return False
