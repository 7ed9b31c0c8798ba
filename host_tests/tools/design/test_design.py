"""tools/design: every closed form against brute force, the stability region point by point, switching bounds with their proofs, what the synthesis
calls least against its neighbours and against formulas. The command and the C configurations: test_design_command.py."""
import itertools
import math
import pathlib
import random
import sys
from fractions import Fraction

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from design_support import impulse_sum, simulated
from system_support import needs, run_all, test

needs("design", "numpy", "scipy")

import numpy as np  # noqa: E402
import scipy.linalg  # noqa: E402
from design import configuration, response, structure, switching, synthesis  # noqa: E402
from design.structure import Filter, alpha_beta, from_alpha_beta_gamma  # noqa: E402
from design.synthesis import REGIONS, Infeasible, Request  # noqa: E402

GRID = 400
# a1, b0, NG, Pe / R, D, slowest pole, step settled from, peak, at, h0..h3 (notes of paper 000: synthesised-filter, section 1)
TABLE = (
    (-0.3, 0.1, 0.822358, 1.002911, 6.3, 0.95781, 90, 1.6853, 7, (0.1, 0.207, 0.28449, 0.317814)),
    (0.0, 0.1, 0.513514, 0.621622, 9.0, 0.94868, 70, 1.6037, 8, (0.1, 0.18, 0.234, 0.2592)),
    (0.0, 0.3, 0.548387, 0.935484, 2.3333, 0.83666, 21, 1.3979, 4, (0.3, 0.42, 0.378, 0.2352)),
    (-0.3, 0.5, 0.739631, 1.958525, 0.7, 0.75183, 11, 1.3362, 2, (0.5, 0.575, 0.26125, -0.084562)),
    (0.0, 2 / 3, 0.666667, 2.0, 0.5, 0.57735, 6, 1.1852, 2, (0.666667, 0.444444, 0.074074, -0.098765)),
    (-1 / 6, 11 / 13, 0.805937, 3.800842, 0.151515, 0.42173, 3, 1.1282, 1, (0.846154, 0.282051, -0.079553, -0.062678)),
    (0.5, 0.5, 0.5, 1.0, 1.5, 0.74092, 11, 1.2422, 3, (0.5, 0.375, 0.28125, 0.085938)),
)
# range of a1, of b0, verdict, least and largest joint spectral radius (the same notes)
BANDS = (
    ((0, 0), (0.4, 1), "safe", 0.89, 0.91), ((0, 0), (0.3, 1), "safe", 0.9925, 0.999), ((0, 0), (0.29, 1), "unsafe", 1.0027, 1.1),
    ((0, 0), (0.2, 1), "unsafe", 1.085, 1.2), ((-1 / 3, 0), (0.5, 1), "safe", 0.91, 0.93), ((-1 / 3, 0), (0.41, 1), "safe", 0.98, 0.998),
    ((-1 / 3, 0), (0.4, 1), "unsafe", 1 - 1e-9, 1.1), ((-0.3, 0), (0.4, 1), "safe", 0.98, 0.997), ((0, 0), (0.1, 0.2), "safe", 0, 0.999),
    ((0, 0), (0.2, 0.6), "safe", 0, 0.999), ((0, 0), (0.3, 0.8), "safe", 0, 0.999), ((-1 / 3, 0), (0.2, 0.4), "safe", 0, 0.999),
    ((-1 / 3, 0), (0.3, 0.6), "safe", 0, 0.999),
)


def near(found, wanted, allowed, what):
    assert abs(found - wanted) <= allowed, f"{what}: {found!r}, not {wanted!r} (+- {allowed:g})"


def random_filters(seed, count):
    """Stable filters of many orders, poles not too near the circle."""
    chance = random.Random(seed)
    found = []
    while len(found) < count:
        v, k, l = chance.randint(1, 3), chance.randint(0, 2), chance.randint(0, 2)  # noqa: E741
        f = Filter(v, tuple(chance.uniform(-0.9, 0.9) for _ in range(k)), (chance.uniform(0.2, 0.98), *(chance.uniform(-0.6, 0.6) for _ in range(l))))
        if f.stable() and response.pole_radius(f) < 0.985:
            found.append(f)
    return found


@test
def stability_is_exact_on_the_grid():
    a1 = np.repeat((np.arange(GRID) + 0.5) * 2 / GRID - 1, GRID)
    b0 = np.tile((np.arange(GRID) + 0.5) / GRID, GRID)
    moves = np.zeros((a1.size, 3, 3))
    moves[:, 0, :] = ((1 - b0) * np.array([2 - a1, 2 * a1 - 1, -a1])).T
    moves[:, 1, 0] = moves[:, 2, 1] = 1
    radius = np.abs(np.linalg.eigvals(moves)).max(axis=1)
    region = (1 + 2 * a1 * (1 - b0) > 0) & (4 - 3 * b0 - 4 * a1 * (1 - b0) > 0)
    found = np.array([structure.schur_cohn((1.0, -(1 - b) * (2 - a), (1 - b) * (1 - 2 * a), (1 - b) * a)) for a, b in zip(a1.tolist(), b0.tolist())])
    assert (found == (radius < 1)).all(), f"{(found != (radius < 1)).sum()} points otherwise than their poles"
    assert (found == region).all(), f"{(found != region).sum()} points otherwise than the region"
    papers = (a1 < 0) & (b0 > -a1 - 0.3)
    assert found[papers].all() and (found & (a1 < 0) & ~papers).sum() > 1000, "the papers' condition is sufficient, not necessary"


@test
def the_border_itself_is_unstable_in_rational_numbers():
    for numerator in range(1, 100):
        a1 = Fraction(-100 - numerator, 200)
        b0 = 1 + 1 / (2 * a1)  # 1 + 2 a1 (1 - b0) = 0
        least = Fraction(1, 10 ** 30)
        assert not Filter(2, (a1,), (b0,)).stable() and not Filter(2, (a1,), (b0 - least,)).stable() and Filter(2, (a1,), (b0 + least,)).stable(), a1


@test
def random_polynomials_agree_with_their_roots():
    chance, seen = random.Random(1), [0, 0]
    for _ in range(3000):
        roots = [chance.uniform(-1.3, 1.3) for _ in range(chance.randint(0, 3))]
        c = [chance.choice((1.0, -2.0))]
        for root in roots:
            c = structure.product(c, [1, -root])
        for _ in range(chance.randint(0, 2)):
            size, turn = chance.uniform(0, 1.2), chance.uniform(0, math.pi)
            c = structure.product(c, [1, -2 * size * math.cos(turn), size * size])
            roots.append(size)
        largest = max([abs(r) for r in roots], default=0.0)
        if abs(largest - 1) < 1e-6:
            continue
        assert structure.schur_cohn(c) == (largest < 1), (c, roots)
        seen[largest < 1] += 1
    assert min(seen) > 300, seen


@test
def noise_gain_is_that_of_brute_force():
    closed = 0
    for f in random_filters(2, 60) + [alpha_beta(0.5, 0.2), from_alpha_beta_gamma(0.6, 0.3, 0.05)]:
        summed = impulse_sum(f, 4000)
        near(f.noise_gain(), summed, 1e-9 * summed, f"recursion of {f}")
        near(float(f.exact().noise_gain()), summed, 1e-9 * summed, f"rational {f}")
        near(response.lyapunov_noise_gain(f), summed, 1e-9 * summed, f"Lyapunov of {f}")
        formula = structure.closed_noise_gain(f)
        if formula is not None:
            closed += 1
            near(formula, summed, 1e-9 * summed, f"closed form of {f}")
    assert closed >= 12, closed
    assert Filter(2, (-0.9,), (0.1,)).noise_gain() == math.inf


@test
def dynamic_error_is_that_of_the_filter_run():
    for f in random_filters(3, 30):
        signal = [math.comb(n + f.v - 1, f.v) for n in range(1200)]  # its v-th difference is 1
        wave = simulated(f, 1200, lambda n: float(signal[n]))
        near(f.dynamic_error(), signal[-1] - wave[-1], 1e-9 * (1 + signal[-1] * 1e-6), f"{f}")
        near(response.moving_error(f, 300)[200], signal[200] - wave[200], 1e-9 * signal[200], f"{f} on the way")
    near(Filter(2, (0.0,), (0.3,)).dynamic_error(), 7 / 3, 1e-12, "(0, 0.3)")


@test
def table_of_the_notes():
    for a1, b0, noise, extrapolated, error, radius, settled, peak, peak_at, head in TABLE:
        f, what = Filter(2, (a1,), (b0,)), f"({a1:.3g}, {b0:.3g})"
        near(f.noise_gain(), noise, 6e-7, f"NG of {what}")
        near((f.noise_gain() - b0 * b0) / (1 - b0) ** 2, extrapolated, 6e-7, f"Pe/R of {what}")
        near(f.dynamic_error(), error, 6e-5, f"D of {what}")
        near(response.pole_radius(f), radius, 6e-6, f"pole of {what}")
        wave = response.step(f)
        assert (wave.settled_at, wave.peak_at) == (settled, peak_at), (what, wave)
        near(wave.peak, peak, 6e-5, f"peak of {what}")
        for n, x in enumerate(simulated(f, 4, lambda n: float(n == 0))):
            near(x, head[n], 6e-7, f"h{n} of {what}")
            near(response.impulse(f, 4)[n], x, 1e-12, f"impulse {n} of {what}")
    # where the note's column rounds ln 0.02 / ln rho to the nearest, here it is the first sample within 2 %
    assert [response.settling_by_radius(Filter(2, (a,), (b,))) for a, b, *_ in TABLE] == [91, 75, 22, 14, 8, 5, 14]


@test
def the_printed_arrangement_is_that_of_equation_17():
    f = structure.as_printed(2, (-0.2,), (0.4, -0.1))
    plain, past_x, past_u = Filter(2, (-0.2,), (0.4,)), [0.0] * 3, 0.0
    for n, x in enumerate(simulated(f, 30, lambda n: float(n == 3))):
        expected = sum(-w * y for w, y in zip(plain.a_polynomial[1:], past_x))
        u = float(n == 3) - expected
        wanted = expected + 0.4 * u - 0.1 * past_u
        past_x, past_u = [wanted, *past_x[:2]], u
        near(x, wanted, 1e-12, f"sample {n}")


def steady_kalman(moves, drive, noise):
    """(gains, transition) of a steady filter that measures the first state."""
    size = len(moves)
    measured = np.zeros((1, size))
    measured[0, 0] = 1
    p = scipy.linalg.solve_discrete_are(moves.T, measured.T, drive, np.array([[noise]]))
    gain = (p @ measured.T / (p[0, 0] + noise)).ravel()
    return gain


def kalman_impulse(moves, gain, samples):
    state, out = np.zeros(len(moves)), []
    for n in range(samples):
        expected = moves @ state
        state = expected + gain * (float(n == 0) - expected[0])
        out.append(state[0])
    return np.array(out)


@test
def singer_filters_are_of_the_structure():
    cases = ((0.7, 0.01, (0.509563, -0.678818, 0.239285)), (0.9, 0.001, (0.423581, -0.682675, 0.283102)),
             (1.0, 0.0005, (0.431300, -0.733268, 0.318831)))
    for rho, drive, b in cases:
        moves = np.array([[1, 1, 0], [0, 1, 1], [0, 0, rho]], float)
        gain = steady_kalman(moves, np.diag([0, 0, drive]), 1.0)
        # x(n) of A x(n) = w(n - 2), A = (1 - z^-1)^2 (1 - rho z^-1): the spectrum is all that the steady filter of x knows
        wave = kalman_impulse(moves, gain, 200)
        fitted = fitted_b(wave, Filter(2, (-rho,), (0.5,)).a_polynomial, 2)
        f = Filter(2, (-rho,), tuple(fitted))
        near(float(np.abs(response.impulse(f, 200) - wave).max()), 0.0, 1e-11, f"Singer {rho}")
        for found, wanted in zip(fitted, b):
            near(found, wanted, 6e-7, f"Singer {rho}")


def fitted_b(wave, a, l):  # noqa: E741
    """b0..bl for which A x^ = B u: u = (g - x^) / (1 - b0), b0 = the first of the wave."""
    b0 = wave[0]
    u = (np.eye(1, len(wave))[0] - wave) / (1 - b0)
    left = np.convolve(a, wave)[:l + 1]
    found = []
    for n in range(l + 1):
        found.append((left[n] - sum(found[j] * u[n - j] for j in range(n))) / u[0])
    return found


@test
def alpha_beta_and_alpha_beta_gamma_are_of_the_structure():
    for drive in (1e-4, 1e-2, 0.5):
        moves = np.array([[1, 1], [0, 1]], float)
        gain = steady_kalman(moves, np.diag([0, drive]), 1.0)
        f = configuration.steady_kalman(2, drive)
        near(float(sum(f.b)), float(f.b[0]) ** 2 / (2 - float(f.b[0])), 1e-12, "beta = alpha^2 / (2 - alpha)")
        near(configuration.drive_of(f), drive, 1e-12 + 1e-10 * drive, "drive")
        cube = np.array([[1, 1, 0], [0, 1, 1], [0, 0, 1]], float)
        third = configuration.steady_kalman(3, drive)
        wave = kalman_impulse(cube, steady_kalman(cube, np.diag([0, 0, drive]), 1.0), 300)
        near(float(np.abs(response.impulse(third, 300) - wave).max()), 0.0, 1e-10, "three states")
        near(float(f.b[0]), gain[0], 1e-9, "alpha")
        near(float(sum(f.b)), gain[1], 1e-9, "beta")
        near(float(np.abs(response.impulse(f, 300) - kalman_impulse(moves, gain, 300)).max()), 0.0, 1e-12, "alpha-beta")
    moves, gain = np.array([[1, 1, 0.5], [0, 1, 1], [0, 0, 1]]), np.array([0.6, 0.3, 0.05])
    f = from_alpha_beta_gamma(*gain)
    near(float(np.abs(response.impulse(f, 300) - kalman_impulse(moves, gain, 300)).max()), 0.0, 1e-12, "alpha-beta-gamma")
    for found, wanted in zip(structure.alpha_beta_gamma(f), gain):
        near(found, wanted, 1e-15, "back")
    near(f.dynamic_error(), (1 - 0.6) / 0.05, 1e-12, "D of alpha-beta-gamma")


def proves(band, found, products_max=400_000):
    """Whether every sequence of the band's corners begins with a product of norm at most high^m: walks the whole tree, level by level."""
    back = np.linalg.inv(found.norm)
    corners = np.array([found.norm @ f @ back / found.high for f in band.corners()])  # so that long products neither vanish nor overflow
    if np.abs(np.linalg.eigvals(corners)).max() > 1:
        return False
    size = corners.shape[-1]
    products, used = np.eye(size)[None], 0
    while len(products):
        used += len(products) * len(corners)
        if used > products_max:
            return False
        products = (corners[:, None] @ products).reshape(-1, size, size)
        products = products[np.linalg.norm(products, 2, axis=(1, 2)) > 1]
    return True


@test
def switching_table_of_the_notes():
    for a, b, verdict, least, largest in BANDS:
        band = switching.Band(2, (a,), (b,))
        found = switching.bounds(band)
        what = f"{band.text()}: {found.low:.6f}..{found.high:.6f}"
        assert found.verdict == verdict, what
        assert found.low >= least - 1e-12 and (found.high if verdict == "safe" else found.low) <= largest, what
        corners = band.corners()
        together = np.linalg.multi_dot([corners[c] for c in reversed(found.word)]) if len(found.word) > 1 else corners[found.word[0]]
        near(float(switching.spectral_radius(together)) ** (1 / len(found.word)), found.low, 1e-9, f"word of {what}")
        assert proves(band, found), what
        too_low = switching.Bounds(found.low, found.low - 1e-6, found.word, found.norm, found.depth)
        assert not proves(band, too_low, 20_000), f"a bound below the truth is proved: {what}"


@test
def no_product_beats_the_bounds():
    for a, b in (((-1 / 3, 0), (0.5, 1)), ((0, 0), (0.3, 1)), ((-0.5, 0.2), (0.6, 0.9))):
        band = switching.Band(2, (a,), (b, (-0.1, 0.05)))
        found, corners = switching.bounds(band), band.corners()
        chance = random.Random(4)
        for _ in range(2000):
            inside = np.eye(len(corners[0]))
            count = chance.randint(1, 9)
            for _ in range(count):
                f = Filter(2, (chance.uniform(*a),), (chance.uniform(*b), chance.uniform(-0.1, 0.05)))
                inside = np.array(structure.matrices(f)[0], float) @ inside
            grown = float(switching.spectral_radius(inside)) ** (1 / count)
            assert grown <= found.high + 1e-12, (band.text(), grown, found)


@test
def least_noise_of_the_notes():
    for error, noise_one_gain, noise_alpha_beta in ((9, 0.5135, 0.2653), (1, 0.600, 0.556), (0.25, 0.75, 0.75), (0.1, 0.8408, 0.8499)):
        f, g = synthesis.least_noise(Request(2, 1, 0), error), synthesis.least_noise(Request(2, 0, 1), error)
        near(f.noise_gain(), noise_one_gain, 6e-4, f"one gain at D = {error}")
        near(g.noise_gain(), noise_alpha_beta, 6e-4, f"alpha-beta at D = {error}")
        assert f.dynamic_error() <= error * (1 + 1e-9) and g.dynamic_error() <= error * (1 + 1e-9)
        if error >= 0.25:
            near(f.a[0], 0.0, 1e-6, "a1")
            near(f.b[0], 1 / (1 + error), 1e-6, "b0")
        root = math.sqrt(error)
        near(g.noise_gain(), (1 + 4 * root) / (1 + 2 * root) ** 2, 1e-12, "alpha-beta's formula")
        near(synthesis.by_formula(2, 0, error).noise_gain(), (1 + 2 * error) / (1 + 4 * error), 1e-12, "the formula of one gain")
        near(configuration.kalman_for(2, error, None).b[0], 4 / (3 + math.sqrt(1 + 8 * error)), 1e-9, "the Kalman filter's formula")
    near(f.a[0], -0.379, 6e-4, "a1 at D = 0.1")
    near(f.b[0], 0.861, 6e-4, "b0 at D = 0.1")


@test
def formulas_are_what_the_search_finds():
    for v, l in ((1, 0), (2, 0), (2, 1)):  # noqa: E741
        for error in (0.05, 0.6, 4.0, 250.0):
            noise, f = Request(v, 0, l).search().least(error)
            known = synthesis.by_formula(v, l, error)
            near(noise, known.noise_gain(), 1e-8, f"{v}, {l}, {error}")
            near(known.dynamic_error(), error, 1e-9 * error, f"D of {known}")
            near(synthesis.error_by_formula(v, l, known.noise_gain()), error, 1e-7 * error, f"back of {known}")


@test
def nothing_on_a_grid_or_nearby_is_better():
    for error in (0.1, 0.4, 3.0):
        least = synthesis.least_noise(Request(2, 1, 0), error).noise_gain()
        cells = [Filter(2, (a,), (b,)) for a, b in itertools.product(np.linspace(-1, 0, 101).tolist(), np.linspace(0.005, 0.999, 200).tolist())]
        best = min(f.noise_gain() for f in cells if f.dynamic_error() <= error and f.stable())
        assert least <= best + 1e-9 and best - least < 0.01, (error, least, best)
    chance = random.Random(5)
    for order, extra in (((3, 0, 2), {}), ((1, 0, 1), {}), ((2, 1, 2), {"fixed_a": (-0.7,)}), ((4, 0, 3), {})):
        f = synthesis.least_noise(Request(*order, **extra), 5.0)
        better = 0
        for _ in range(3000):
            size = 10 ** chance.uniform(-5, -1)
            g = Filter(f.v, f.a, tuple(x + size * chance.uniform(-1, 1) for x in f.b))
            better += g.stable() and 0 < g.b[0] < 1 and 0 <= g.dynamic_error() <= 5.0 and g.noise_gain() < f.noise_gain() * (1 - 1e-6)
        assert better == 0, f"{f}: {better} better nearby"


@test
def never_worse_than_the_steady_kalman_filter():
    for v in (1, 2, 3, 4):
        for error in (0.3, 10.0, 1e3, 3e4 if v > 1 else 3e3):
            kalman = configuration.kalman_for(v, error, None)
            near(float(kalman.exact().dynamic_error()), error, 1e-6 * error, f"D of {kalman}")
            least = synthesis.least_noise(Request(v, 0, v - 1), error)
            ratio = float(least.exact().noise_gain() / kalman.exact().noise_gain())
            assert 0.8 < ratio <= 1 + 1e-6, (v, error, ratio)


@test
def one_bound_gives_back_the_other():
    for order, error in (((2, 1, 0), 3.0), ((2, 1, 0), 0.1), ((2, 0, 1), 3.0), ((3, 0, 2), 20.0), ((1, 0, 1), 2.0)):
        noise = synthesis.least_noise(Request(*order), error).noise_gain()
        f = synthesis.least_error(Request(*order), noise)
        assert f.noise_gain() <= noise * (1 + 1e-12), (order, f)
        near(f.dynamic_error(), error, 2e-4 * error, f"{order} at {noise}")


@test
def floors_and_regions():
    near(synthesis.floor(Request(2, 1, 0)), 0.5, 2e-4, "B = b0, a1 <= 0")
    near(synthesis.floor(Request(2, 1, 0, REGIONS["exact"])), 1 / 3, 2e-3, "B = b0, any a1")
    assert synthesis.floor(Request(2, 0, 1)) == 0.0
    f = synthesis.least_noise(Request(2, 1, 0, REGIONS["safe"]), 9.0)
    assert f.b[0] >= 0.5 and -1 / 3 <= f.a[0] <= 0
    slow = 0.02 ** (1 / 12)
    assert response.pole_radius(synthesis.least_noise(Request(2, 1, 0, slowest=slow), 9.0)) <= slow + 1e-9
    for bad in (Request(2, 1, 2), Request(1, 1, 0), Request(0, 0, 0), Request(2, 0, 9), Request(2, 1, 0, fixed_a=(-1.0,)),
                Request(2, 2, 0, fixed_a=(0.1,))):
        try:
            synthesis.least_noise(bad, 1.0)
        except Infeasible as problem:
            assert "nearest" in str(problem) or "must be" in str(problem), problem
        else:
            raise AssertionError(f"{bad} gives a filter")


if __name__ == "__main__":
    sys.exit(run_all())
