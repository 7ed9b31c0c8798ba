"""Parametric synthesis: the parameters that minimise either noise gain or dynamic error while the other keeps its bound.

In powers of s = 1 - z^-1 the loop is B / (1 - b0) = e0 + e1 s + ... + el s^l against A = s^v (1 + a1 z^-1 + ...), which separates the roles of
the parameters: the dynamic error is D = (1 + sum a) / e0, and 0 < b0 < 1 is e0 + ... + el > 0. With w^v = e0 the numbers ej / w^(v-j) stay
about 1 however slow the filter is, so the search runs over them and over D; a search over b0..bl would meet a thin sliver.
"""
import dataclasses
import functools
import itertools
import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from .structure import Filter, alpha_beta, difference, power, power_and_margin, product, schur_cohn, total

ORDER_MAX = 10  # v + k + l: above it, double precision cannot hold the coefficients of a slow filter
ERROR_MIN, ERROR_MAX = 1e-6, 1e4  # range of requested dynamic errors per difference: every search works and every response ends
ERROR_STEP = 30.0  # if no filter is found, the error searched for is reduced by this factor
LEAST_SHAPE = 1e-6  # least 1 + sum a, to which the dynamic error is proportional
NOISE_MIN = 1e-4  # least noise gain that can be requested
ABOVE_FLOOR = 0.003  # proposed noise gain above the least one, which is a limit that is not reached
B0_MAX = 1 - 1e-9
SOUND = 1e-12  # the product of 1 - reflection^2 below which rounding spoils the noise gain
TRUE = 1e-3  # relative difference allowed between noise gains in floating point and in rationals
HALVINGS = 36
NOTHING = 1e-7  # a sum of a below this, far under 1/65536, counts as 0
EDGES = tuple(math.log(x) for x in (ERROR_MIN, 1e-4, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3, ERROR_MAX))  # where the least noise gain is bracketed
DIFFERENCES = [difference(order) for order in range(ORDER_MAX + 1)]
KEPT_REQUESTS = 256  # requests whose search is cached
WALL = 1e5  # cost of a place outside the region or the unit circle
BUTTERWORTH = {1: (1.0,), 2: (1.0, math.sqrt(2.0)), 3: (1.0, 2.0, 2.0), 4: (1.0, 2.613, 3.414, 2.613)}


class Infeasible(Exception):
    """One sentence: why there is no such filter, and the nearest possible one."""


class NoneFound(Infeasible):
    """The sentence without the nearest: that depends on the other bounds."""


@dataclass(frozen=True)
class Region:
    """The allowed parameters; the papers' region by default."""

    name: str
    a_sum: tuple  # of a1 + ... + ak
    b0: tuple = (1e-9, B0_MAX)

    def text(self, of_a=True):
        """The conditions on a (if there is one to choose) and b0; "" for none."""
        words = [f"{self.a_sum[0]:.4g} <= sum a <= {self.a_sum[1]:.4g}"] if of_a else []
        return ", ".join(words + ([f"b0 >= {self.b0[0]:g}"] if self.b0[0] > 1e-6 else []))


REGIONS = {
    "paper": Region("paper", (-1.0, 0.0)),
    "exact": Region("exact", (-65535 / 65536, 65535 / 65536)),
    "safe": Region("safe", (-1 / 3, 0.0), (0.5, B0_MAX)),
}


def check_order(v, k, l):  # noqa: E741
    if v < 1 or k < 0 or l < 0 or v + k + l > ORDER_MAX:
        near_v, near_k = min(max(v, 1), ORDER_MAX), max(k, 0)
        near_k = min(near_k, ORDER_MAX - near_v)
        raise Infeasible(f"(v, k, l) = ({v}, {k}, {l}): v must be 1 or more, k and l 0 or more, and v + k + l at most {ORDER_MAX}; "
                         f"nearest: -v {near_v} -k {near_k} -l {min(max(l, 0), ORDER_MAX - near_v - near_k)}")


def rounded(value, up=True, digits=4):
    """Rounds a positive number up (or down) to so many digits. Near 1 the digits are those of 1 - value, so that it stays below."""
    fine = min(value, 1 - value) if 0 < value < 1 else value
    unit = 10.0 ** (math.floor(math.log10(fine)) + 1 - digits)
    return float(f"{(math.ceil if up else math.floor)(value / unit) * unit:.12g}")


def from_memory(e):
    """b0..bl with B / (1 - b0) = sum e_j (1 - z^-1)^j."""
    b = [0.0] * len(e)
    for j, factor in enumerate(e):
        for i, coefficient in enumerate(DIFFERENCES[j]):
            b[i] += factor * coefficient
    b0 = b[0] / (1 + b[0])
    return (b0, *[x * (1 - b0) for x in b[1:]])


def shape_from(units, region):
    """a1..ak from k numbers: the first is their sum, clipped to the region; the others separate the zeros of 1 + a1 z^-1 + ...."""
    k = len(units)
    if k == 0:
        return []
    whole = min(max(units[0], region.a_sum[0]), region.a_sum[1])
    whole = 0.0 if abs(whole) < NOTHING else whole
    return [whole - sum(units[1:]), *units[1:]]


class Search:
    """The least noise gain of one structure for a dynamic error of at most D."""

    def __init__(self, v, k, l, region, fixed_a=None, slowest=None):  # noqa: E741
        check_order(v, k, l)
        self.v, self.k, self.l = v, k, l
        self.region, self.fixed_a = region, fixed_a
        self.slowest = slowest  # the largest pole radius allowed, None: any
        self.free_a = 0 if fixed_a is not None else k
        self.fixed_shape = product(DIFFERENCES[v], (1, *(fixed_a or ())))  # A(z), if a is fixed
        self.known = []  # results of earlier searches: starts for the next

    def parameters_at(self, place, error_max):
        """(a1..ak, b0..bl) at a place of the search: log of D / error_max (at most 0), sum and others of a, scaled e1..el."""
        a = self.fixed_a if self.fixed_a is not None else shape_from(place[1:1 + self.free_a], self.region)
        shape = max(1 + sum(a), 1e-12)
        e0 = shape / (error_max * math.exp(min(place[0], 0.0)))
        if self.l == 0:
            e0 = max(e0, self.region.b0[0] / (1 - self.region.b0[0]))
        speed = e0 ** (1 / self.v)
        scaled = place[1 + self.free_a:]
        e = [e0] + [scaled[j - 1] * (speed ** (self.v - j) if j < self.v else 1.0) for j in range(1, self.l + 1)]
        return tuple(a), from_memory(e)

    def filter_at(self, place, error_max):
        return Filter(self.v, *self.parameters_at(place, error_max))

    def cost(self, place, error_max):
        try:
            a, b = self.parameters_at(place, error_max)
        except (OverflowError, ZeroDivisionError):
            return 10 * WALL
        low, high = self.region.b0
        if not low <= b[0] <= high:
            return 2 * WALL
        c = total(b, self.fixed_shape if self.free_a == 0 else product(DIFFERENCES[self.v], (1, *a)), 1 - b[0])
        noise, sound = power_and_margin(b, c)
        if not sound > SOUND or (self.free_a > 1 and self.outside(a)):
            return 2 * WALL
        if self.slowest is not None and not schur_cohn([x / self.slowest ** i for i, x in enumerate(c)]):
            return WALL
        beyond = max(0.0, place[0]) + (abs(place[1] - sum(a)) if self.free_a else 0.0)
        return noise * (1 + beyond)

    @staticmethod
    def outside(a):
        return max(abs(np.roots([1, *a]))) > 1 + 1e-9

    def starts(self):
        low, high = self.region.a_sum
        sums = sorted({min(high, 0.0), 0.4 * low, 0.8 * low, 0.8 * high}) if self.free_a else [None]
        wave = BUTTERWORTH[min(self.v, 4)]
        for shrink, whole, stiff in itertools.product((0.0, -3.0, -8.0), sums, (1.0, 1.8) if self.l else (1.0,)):
            memory = [stiff * wave[j] if j < len(wave) else 0.1 * stiff for j in range(1, self.l + 1)]
            if shrink == 0.0 and self.v == 3 and self.l >= 2:  # the ratios of the slow steady Kalman filter
                yield [0.0] + ([whole] + [0.0] * (self.free_a - 1) if self.free_a else []) + [2.0, 2.0] + [0.0] * (self.l - 2)
            yield [shrink] + ([whole] + [0.0] * (self.free_a - 1) if self.free_a else []) + memory

    def least(self, error_max, quick=False):
        """(noise gain, filter): the best one found; None if there is none. A smaller error keeps the bound too."""
        found = self.at_most(error_max, quick)
        while found is None and not quick and error_max > ERROR_MIN:
            error_max = max(error_max / ERROR_STEP, ERROR_MIN)
            found = self.at_most(error_max)
        return found

    def at_most(self, error_max, quick=False):
        """The same, but only from starts near that error."""
        starts = self.known[-2:] if quick and self.known else self.known[-2:] + list(self.starts())
        ranked = sorted(starts, key=lambda place: self.cost(place, error_max))
        spreads = (0.05,) if quick else (0.3, 0.02)
        for cost, place in sorted((self.polished(place, error_max, spreads) for place in ranked[:6]), key=lambda one: one[0]):
            if cost >= WALL:
                break
            f = self.filter_at(place, error_max)
            gain = float(f.exact().noise_gain())
            if abs(gain / power(f.b, f.characteristic) - 1) < TRUE:
                self.known.append(place)
                return gain, f
        return None

    def polished(self, place, error_max, spreads):
        """(cost, place) of the minimum around a place."""
        found = None
        for spread in spreads:
            at = place if found is None else found[1]
            corners = [at] + [[x + ((-spread if i == 0 else spread) if i == j else 0.0) for j, x in enumerate(at)] for i in range(len(at))]
            new = minimize(lambda tried: self.cost(tried.tolist(), error_max), at, method="Nelder-Mead", options={
                "initial_simplex": corners, "xatol": 1e-10, "fatol": 1e-15, "maxfev": 250 * len(at)})
            found = (new.fun, new.x.tolist()) if found is None or new.fun < found[0] else found
        return found


def by_formula(v, l, error):  # noqa: E741
    """The least noise gain for a dynamic error if it has a closed form: k = 0 and (v, l) = (1, 0), (2, 0), (2, 1); else None. For alpha-beta
    the stationary point of its noise gain along alpha = 1 - beta D; with t = sqrt D the noise gain there is (1 + 4 t) / (1 + 2 t)^2."""
    if (v, l) == (1, 0) or (v, l) == (2, 0):
        return Filter(v, (), (1 / (1 + error),))
    if (v, l) == (2, 1):
        beta = 2 / (1 + 2 * math.sqrt(error) + 2 * error)
        return alpha_beta(1 - beta * error, beta)
    return None


def error_by_formula(v, l, noise):  # noqa: E741
    """The dynamic error at which `by_formula` has this noise gain; None if there is none."""
    if (v, l) == (1, 0):
        return (1 - noise) / (2 * noise)
    if (v, l) == (2, 0):
        b0 = (4 * noise - 2) / (3 * noise - 1) if noise > 0.5 else 0.0
        return (1 - b0) / b0 if b0 > 0 else None
    if (v, l) == (2, 1):
        root = ((1 + math.sqrt(1 - noise)) / noise - 1) / 2
        return root * root
    return None


@dataclass(frozen=True)
class Request:
    """A structure and its constraints."""

    v: int
    k: int
    l: int  # noqa: E741
    region: Region = REGIONS["paper"]
    fixed_a: tuple = None
    slowest: float = None  # largest pole radius

    @property
    def name(self):
        return f"(v, k, l) = ({self.v}, {self.k}, {self.l})"

    @property
    def limits(self):
        words = self.region.text(bool(self.k) and self.fixed_a is None)
        return f" with {words}" if words else ""

    @property
    def plain(self):
        """Whether the formulas for k = 0 apply."""
        return (self.k == 0 or not any(self.fixed_a or (1,))) and self.slowest is None and self.region.b0[0] < 1e-6

    def search(self):
        return Search(self.v, self.k, self.l, self.region, self.fixed_a, self.slowest)

    def check(self):
        check_order(self.v, self.k, self.l)
        if self.fixed_a is not None and len(self.fixed_a) != self.k:
            raise Infeasible(f"{self.name}: --a has {len(self.fixed_a)} numbers; nearest: -k {len(self.fixed_a)}")
        if self.fixed_a is not None and 1 + sum(self.fixed_a) < LEAST_SHAPE:
            raise Infeasible(f"{self.name}: with a1 + ... + ak = {sum(self.fixed_a):g} the astatism is not {self.v}; "
                             f"nearest: v = {self.v + 1} with one a fewer")
        if self.fixed_a is None and self.slowest is None and self.k >= 1 and self.l >= self.v - 1:
            raise Infeasible(f"{self.name}: the free a tends to sum a = -1, astatism {self.v + 1}, where the filter may be arbitrarily slow and "
                             f"this dynamic error is still 0; nearest: -k 0, or give --a (a1 = minus the correlation of the signal's "
                             f"{ordinal(self.v)} difference) or --settle")


def least_noise(request, error_max):
    """The filter of least noise gain with a dynamic error of at most error_max (per v-th difference of the signal)."""
    request.check()
    if not (math.isfinite(error_max) and error_max > 0):
        raise Infeasible(f"a dynamic error of {error_max:g} is impossible: it must be finite and above 0; nearest: 0.001")
    known = by_formula(request.v, request.l, error_max) if request.plain else None
    if known is not None:
        return Filter(request.v, (0.0,) * request.k, known.b)
    search = request.search()
    found = search.least(error_max)
    if found is None:
        raise NoneFound(f"{request.name}{request.limits} has no stable filter{'' if request.slowest is None else ' that settles in time'}"
                        f" with a dynamic error of at most {error_max:g} per {ordinal(request.v)} difference")
    return found[1]


def ordinal(v):
    return {1: "first", 2: "second", 3: "third"}.get(v, f"{v}th")


@functools.lru_cache(KEPT_REQUESTS)
def floor(request):
    """The infimum of the structure's noise gain over all dynamic errors, found by the search, except for alpha-beta and the average, where it
    is 0."""
    if request.plain and error_by_formula(request.v, request.l, NOISE_MIN) is not None:
        return 0.0
    search = request.search()
    found = [search.least(error) for error in (1.0, 100.0, ERROR_MAX)]
    return min((one[0] for one in found if one is not None), default=math.inf)


def formula_error(request, noise_max):
    """The dynamic error for a noise gain, if a formula has it and it can be computed."""
    error = error_by_formula(request.v, request.l, noise_max) if request.plain else None
    return error if error is not None and (request.l > 0 or error <= ERROR_MAX) else None


class Walk:
    """The least noise gains of a structure at the edges, from the smallest error up, each searched when first needed."""

    def __init__(self, request):
        self.request, self.search = request, request.search()
        self.found = []  # (result at this edge, results of the searches so far)

    def at(self, number):
        while len(self.found) <= number:
            kept = self.search.least(math.exp(EDGES[len(self.found) + 1]))
            self.found.append((kept, tuple(self.search.known)))
        return self.found[number]


walk_of = functools.lru_cache(KEPT_REQUESTS)(Walk)


def bracket(request, noise_max):
    """(logs of two dynamic errors, the noise gain and filter at the larger, which reaches the requested noise gain, a search to continue from);
    None if there is none."""
    walk = walk_of(request)
    for number, (low, high) in enumerate(itertools.pairwise(EDGES)):
        kept, known = walk.at(number)
        if kept is not None and kept[0] <= noise_max:
            search = request.search()
            search.known = list(known)
            return low, high, kept, search
    return None


def reachable(request, noise_max):
    """Whether the structure has a filter with a noise gain of at most this, which is below 1."""
    try:
        request.check()
    except Infeasible:
        return False
    return formula_error(request, noise_max) is not None or bracket(request, noise_max) is not None


def nearest_noise(request, wanted):
    """The requested noise gain if the structure has it, else one just above its floor, as an option of the command."""
    return f"--noise-gain {wanted:.12g}" if reachable(request, wanted) else above(request, floor(request))


def above(request, least):
    """The nearest noise gain above a floor."""
    if least < 1:
        near = rounded(least + min(ABOVE_FLOOR * least, 0.3 * (1 - least)))
        if reachable(request, near):
            return f"--noise-gain {near:.12g}"
    return "none; choose another structure"


def least_error(request, noise_max):
    """The filter of least dynamic error with a noise gain of at most noise_max."""
    request.check()
    if not (math.isfinite(noise_max) and noise_max > 0):
        raise Infeasible(f"a noise gain of {noise_max:g} is impossible: it must be finite and above 0; "
                         f"nearest: {nearest_noise(request, NOISE_MIN if noise_max <= 0 else 0.999)}")
    if noise_max >= 1:
        raise Infeasible(f"a noise gain of {noise_max:g} needs no filter: the raw measurement has 1; nearest: {nearest_noise(request, 0.999)}")
    if noise_max < NOISE_MIN:
        raise Infeasible(f"a noise gain of {noise_max:g} is below the {NOISE_MIN:g} that can be computed; "
                         f"nearest: {nearest_noise(request, NOISE_MIN)}")
    error = formula_error(request, noise_max)
    if error is not None:
        return least_noise(request, error)
    found = bracket(request, noise_max)
    if found is None:
        raise Infeasible(below_floor(request, noise_max))
    low, high, kept, search = found
    for _ in range(HALVINGS):  # the least noise gain falls as the allowed error grows
        middle = 0.5 * (low + high)
        found = search.least(math.exp(middle), quick=True)
        if found is not None and found[0] <= noise_max:
            high, kept = middle, found
        else:
            low = middle
    return kept[1]


def below_floor(request, noise_max):
    least = floor(request)
    return (f"a noise gain of {noise_max:g} is below what {request.name}{request.limits} can reach, {least:.6g}; "
            f"nearest: {above(request, least)}{richer(request, noise_max)}")


def richer(request, noise_max):
    """With B of order v - 1 the noise gain has no floor: proposes that if it helps."""
    if request.l >= request.v - 1:
        return ""
    other = dataclasses.replace(request, l=request.v - 1, k=request.k if request.fixed_a is not None else 0)
    if not reachable(other, noise_max):
        return ""
    return f", or -l {other.l}" if request.fixed_a is not None else f", or -k 0 -l {other.l}"
