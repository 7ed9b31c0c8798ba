"""The structure of papers 000 and 001 and its exact properties. Polynomials are sequences of coefficients in powers of z^-1.

    A(z) = (1 - z^-1)^v (1 + a1 z^-1 + ... + ak z^-k)     B(z) = b0 + b1 z^-1 + ... + bl z^-l

    x_e = [1 - A] x^ + b1 u(n-1) + ... + bl u(n-l)        u = g - x_e        x^ = x_e + b0 u

Hence A x^ = B u (paper 001, equations 5, 13, 16) and, since u is (g - x^) / (1 - b0), x^ = B / C g with C = B + (1 - b0) A. For l = 0 this is
exactly equation 17 of paper 001, C = A + B (1 - A). For l > 0 the paper omits the past innovations from x_e: `as_printed`.
"""
import math
from dataclasses import dataclass
from fractions import Fraction


def product(p, q):
    out = [0] * (len(p) + len(q) - 1)
    for i, left in enumerate(p):
        for j, right in enumerate(q):
            out[i + j] = out[i + j] + left * right
    return out


def difference(order):
    """(1 - z^-1)^order, exact."""
    return [(-1) ** i * math.comb(order, i) for i in range(order + 1)]


def total(p, q, factor=1):
    """p + factor q."""
    size = max(len(p), len(q))
    return [(p[i] if i < len(p) else 0) + factor * (q[i] if i < len(q) else 0) for i in range(size)]


def reflections(c):
    """Schur and Cohn's recursion: all zeros of the polynomial c are inside the unit circle exactly if each of these is below 1 in magnitude.
    Exact for Fractions; stops at the first that is not."""
    found = []
    c = list(c)
    while len(c) > 1:
        ratio = c[-1] / c[0]
        found.append(ratio)
        if not abs(ratio) < 1:
            break
        c = [c[i] - ratio * c[-1 - i] for i in range(len(c) - 1)]
    return found


def schur_cohn(c):
    """Whether every zero of c (first coefficient not 0) lies strictly inside the unit circle."""
    return all(abs(ratio) < 1 for ratio in reflections(c))


def power(b, c):
    """Sum of the squares of the impulse response of b / c, by Astrom, Jury and Agniel's recursion, which is Schur and Cohn's with b carried
    along: no roots, no truncation, exact for Fractions. Infinite if c is unstable."""
    size = max(len(b), len(c))
    b = list(b) + [0] * (size - len(b))
    c = list(c) + [0] * (size - len(c))
    gain, out = c[0], 0
    while True:
        carried = b[-1] / c[0]
        out = out + carried * b[-1]
        if len(c) == 1:
            return out / gain
        ratio = c[-1] / c[0]
        if not abs(ratio) < 1:
            return math.inf
        b = [b[i] - carried * c[-1 - i] for i in range(len(c) - 1)]
        c = [c[i] - ratio * c[-1 - i] for i in range(len(c) - 1)]


def power_and_margin(b, c):
    """(power(b, c), the product of 1 - reflection^2), for floating point and b no longer than c, in one recursion."""
    b, c = [*b, *[0.0] * (len(c) - len(b))], list(c)
    gain, out, margin = c[0], 0.0, 1.0
    while len(c) > 1:
        first, last, carry = c[0], c[-1], b[-1]
        ratio, carried = last / first, carry / first
        margin *= 1 - ratio * ratio
        if not abs(ratio) < 1:
            return math.inf, margin
        out += carried * carry
        turned = c[:0:-1]
        b = [x - carried * y for x, y in zip(b, turned)]
        c = [x - ratio * y for x, y in zip(c, turned)]
    return (out + b[0] / c[0] * b[0]) / gain, margin


@dataclass(frozen=True)
class Filter:
    """One filter of the structure: order of astatism v, a1..ak, b0..bl."""

    v: int
    a: tuple
    b: tuple

    @property
    def k(self):
        return len(self.a)

    @property
    def l(self):  # noqa: E743, the papers' letter
        return len(self.b) - 1

    @property
    def order(self):
        return (self.v, self.k, self.l)

    @property
    def shape(self):
        """1 + a1 z^-1 + ..."""
        return [1, *self.a]

    @property
    def a_polynomial(self):
        return product(difference(self.v), self.shape)

    @property
    def characteristic(self):
        """C = B + (1 - b0) A; its first coefficient is 1."""
        return total(self.b, self.a_polynomial, 1 - self.b[0])

    def exact(self):
        """The same filter in rational numbers."""
        return Filter(self.v, tuple(Fraction(x) for x in self.a), tuple(Fraction(x) for x in self.b))

    def stable(self):
        return schur_cohn(self.characteristic)

    def noise_gain(self):
        """Steady variance of the estimate's error over that of white noise; infinite if unstable."""
        return power(self.b, self.characteristic)

    def dynamic_error(self):
        """Steady error per v-th difference of the signal: (1 - b0) (1 + sum a) / sum b."""
        return (1 - self.b[0]) * sum(self.shape) / sum(self.b)


def as_printed(v, a, b):
    """The filter that equations 15 to 17 of paper 001 give for these polynomials: x_e = [1 - A] x^ alone, so 1 - W = A (1 - B) / C with
    C = A + B (1 - A). Its past innovations raise k by l: A (1 - B) / (1 - b0) replaces A. b0 = 1 with l > 0 has no such form."""
    beyond = [(1 - b[0]) if i == 0 else -x for i, x in enumerate(b)]
    if len(b) == 1:
        return Filter(v, tuple(a), tuple(b))
    shape = product([1, *a], [x / beyond[0] for x in beyond])
    return Filter(v, tuple(shape[1:]), tuple(b))


def closed_noise_gain(f):
    """The noise gain by the closed form for small orders, None for others."""
    if f.order == (1, 0, 0):
        return f.b[0] / (2 - f.b[0])
    if f.order in ((2, 0, 0), (2, 1, 0)):
        b0 = f.b[0]
        ac = (f.a[0] if f.a else 0) * (1 - b0)
        return (2 - b0 - 2 * ac * b0 - 2 * ac * ac) / ((1 + 2 * ac) * (4 - 3 * b0 - 4 * ac))
    if f.order == (2, 0, 1):
        alpha, beta = f.b[0], f.b[0] + f.b[1]
        return (2 * alpha * alpha + beta * (2 - 3 * alpha)) / (alpha * (4 - 2 * alpha - beta))
    if f.order == (3, 0, 2):
        alpha, beta, gamma = alpha_beta_gamma(f)
        above = 2 * beta * (2 * alpha * alpha + 2 * beta - 3 * alpha * beta) - alpha * gamma * (4 - 2 * alpha - beta)
        return above / ((4 - 2 * alpha - beta) * (2 * alpha * beta + alpha * gamma - 2 * gamma))
    return None


def alpha_beta(alpha, beta):
    """x += v + alpha u, v += beta u, u = g - x - v."""
    return Filter(2, (), (alpha, beta - alpha))


def alpha_beta_gamma(f):
    """(alpha, beta, gamma) of x += v + w / 2 + alpha u, v += w + beta u, w += gamma u, u = g - x - v - w / 2, from a filter of (3, 0, 2)."""
    b0, b1, b2 = f.b
    return b0, (3 * b0 + b1 - b2) / 2, b0 + b1 + b2


def from_alpha_beta_gamma(alpha, beta, gamma):
    return Filter(3, (), (alpha, beta + gamma / 2 - 2 * alpha, alpha - beta + gamma / 2))


def matrices(f):
    """State (x^(n-1)..x^(n-v-k), u(n-1)..u(n-l)): (F, G) with s(n) = F s(n-1) + G g(n), as nested lists; x^(n) is the first element."""
    weights = [-x for x in f.a_polynomial[1:]] + list(f.b[1:])
    states, past = f.v + f.k, f.l
    size = states + past
    rows = [[(1 - f.b[0]) * w for w in weights]] + [[1.0 if j == i else 0.0 for j in range(size)] for i in range(states - 1)]
    if past:
        rows.append([-w for w in weights])
        rows += [[1.0 if j == states + i else 0.0 for j in range(size)] for i in range(past - 1)]
    inputs = [0.0] * size
    inputs[0] = f.b[0]
    if past:
        inputs[states] = 1.0
    return rows, inputs
