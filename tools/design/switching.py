"""Is the filter stable if its parameters move within a band from sample to sample, in any order? It is not enough that it is stable with each
parameter fixed. Without measurement noise the state moves by F(parameters), which is affine in each parameter, so over a box of parameters
every F lies in the hull of those at the corners, and the question is whether their joint spectral radius is below 1.

Bounds by Gripenberg's branch and bound: the spectral radius of any product of m corners, to the power 1/m, is a lower bound; if every sequence
of corners begins with a product whose norm is at most r^m, r is an upper bound. The norm is an ellipsoidal one fitted to the corners. The proof
is the tree of those products, which the tests walk again, given only the corners, the norm and the bound."""
import itertools
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from .structure import Filter, matrices

PRODUCTS_MAX = 400_000  # in all; after that the bounds found are returned
WIDTHS = (0.04, 0.02, 0.01, 0.005, 0.0025)
REFINE_MAX = 5000
SURELY_ONE = 1 - 1e-12  # lower bound above which some sequence of corners does not decay
ROUNDING = 1e-9  # far above the rounding of products of tens of matrices


@dataclass(frozen=True)
class Band:
    """Ranges (low, high) of a1..ak and b0..bl; low = high: fixed."""

    v: int
    a: tuple
    b: tuple

    def corner_filters(self):
        """The filters at the corners, one per distinct matrix (at b0 = 1 the others do not matter)."""
        boxes = [sorted({low, high}) for low, high in (*self.a, *self.b)]
        found = {}
        for chosen in itertools.product(*boxes):
            f = Filter(self.v, chosen[:len(self.a)], chosen[len(self.a):])
            found.setdefault((np.array(matrices(f)[0], float).round(14) + 0.0).tobytes(), f)
        return list(found.values())

    def corners(self):
        return [np.array(matrices(f)[0], float) for f in self.corner_filters()]

    def text(self):
        names = [f"a{i + 1}" for i in range(len(self.a))] + [f"b{j}" for j in range(len(self.b))]
        return ", ".join(f"{name} in [{low:.5g}, {high:.5g}]" if low != high else f"{name} = {low:.5g}"
                         for name, (low, high) in zip(names, (*self.a, *self.b)))


@dataclass(frozen=True)
class Bounds:
    low: float  # some product of corners has this spectral radius per factor
    high: float  # no sequence of corners grows faster
    word: tuple  # the corners of that product
    norm: np.ndarray  # coordinates in which the upper bound is proved
    depth: int  # longest product of the proof

    @property
    def verdict(self):
        if self.high < 1:
            return "safe"
        return "unsafe" if self.low >= SURELY_ONE else "undecided"


def spectral_radius(products):
    return np.abs(np.linalg.eigvals(products)).max(axis=-1)


def sizes(products):
    return np.linalg.norm(products, ord=2, axis=(-2, -1))


def fitted_norm(corners, radius, rounds=60):
    """Coordinates T so that |T F T^-1| is small: T'T from the sum over corners of (F / r)' P (F / r), a Lyapunov equation common to all corners,
    with the growth r between the mean and the maximum."""
    size = len(corners[0])
    best, best_size = np.eye(size), np.inf
    for factor in (1.0, 1.05, 1.15, 1.3, 1.5, 1.8):
        p = np.eye(size)
        for _ in range(rounds):
            p = np.eye(size) * np.trace(p) * 1e-3 + sum(f.T @ p @ f for f in corners) / (factor * radius) ** 2
            p /= np.trace(p)
        change = np.linalg.cholesky(p).T
        back = np.linalg.inv(change)
        largest = max(sizes(np.array([change @ f @ back for f in corners])))
        if largest < best_size:
            best, best_size = change, largest
    return best


def in_coordinates(corners, norm):
    back = np.linalg.inv(norm)
    return np.array([norm @ f @ back for f in corners])


def branch(corners, low, word, width, budget):
    """(lower bound, its word, upper bound, depth, products used) of one run of Gripenberg's algorithm."""
    size = corners.shape[-1]
    products, words = np.eye(size)[None], [()]
    reached = np.full(1, np.inf)  # the least norm per factor along the way to each node
    used = depth = 0
    while len(words) and used + len(words) * len(corners) <= budget:
        depth += 1
        products = np.einsum("cij,njk->ncik", corners, products).reshape(-1, size, size)
        words = [(*w, c) for w in words for c in range(len(corners))]
        used += len(words)
        radii = spectral_radius(products) ** (1 / depth)
        top = int(np.argmax(radii))
        if radii[top] > low:
            low, word = float(radii[top]), words[top]
        reached = np.minimum(np.repeat(reached, len(corners)), sizes(products) ** (1 / depth))
        open_nodes = reached > low + width
        products, reached = products[open_nodes], reached[open_nodes]
        words = [w for w, keep in zip(words, open_nodes) if keep]
    high = max(low + width, float(reached.max())) if len(words) else low + width
    return low, word, high, depth, used


def refined_norm(corners, norm, length):
    """Moves the norm's triangle so that the largest product of `length` corners becomes small."""
    size = norm.shape[0]
    places = np.tril_indices(size)
    products = [np.eye(size)]
    for _ in range(length):
        products = [f @ p for f in corners for p in products]
    products = np.array(products)

    def largest(entries):
        change = np.zeros((size, size))
        change[places] = entries
        if np.abs(np.diag(change)).min() < 1e-6 * np.abs(change).max():
            return 1e9
        return float(sizes(change @ products @ np.linalg.inv(change)).max())

    # the same norm by a lower triangle: T = Q L
    lower = np.linalg.cholesky((norm.T @ norm)[::-1, ::-1])[::-1, ::-1].T
    at = lower[places] / np.abs(lower).max()
    for _ in range(3):
        at = minimize(largest, at, method="Nelder-Mead", options={"maxfev": 250 * at.size, "xatol": 1e-8, "fatol": 1e-10}).x
    change = np.zeros((size, size))
    change[places] = at
    return change


def searched(raw, norm, low, word, products_max):
    """Bounds in one norm, with ever smaller distance between the two until the verdict is certain."""
    corners = in_coordinates(raw, norm)
    high, depth, left = float(sizes(corners).max()), 1, products_max
    for width in WIDTHS:
        low, word, new, deep, used = branch(corners, low, word, width, left)
        if new < high:
            high, depth = new, deep
        left -= used
        if left <= 0 or (high < 1 and high - low <= 0.011) or low >= SURELY_ONE:
            break
    return Bounds(low, high + ROUNDING, word, norm, depth)


def bounds(band, products_max=PRODUCTS_MAX):
    """Bounds of the joint spectral radius over a band."""
    raw = band.corners()
    radii = [float(spectral_radius(f)) for f in raw]
    low, word = max(radii), (int(np.argmax(radii)),)
    size = len(raw[0])
    if low <= 1e-12 and len(raw) == 1:
        return Bounds(low, 1e-12, word, np.eye(size), size)
    norm = fitted_norm(raw, max(low, 0.1))
    found = searched(raw, norm, low, word, products_max)
    for length in (4, 6):
        if found.verdict != "undecided" or len(raw) ** length > REFINE_MAX or size > 6:
            break
        norm = refined_norm(raw, norm, length)
        again = searched(raw, norm, found.low, found.word, products_max)
        found = again if again.high < found.high else found
    return found
