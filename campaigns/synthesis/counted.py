"""One step of a filter written out as the papers print it, on numbers that count what is done with them: paper 002's Table 2 counts multiplications
and additions of a Kalman filter in matrices, and paper 000 says that its algorithm (22) is of low complexity."""


class Number:
    """Counts on `done`, which all numbers of a step share: products, sums, quotients."""

    def __init__(self, value, done):
        self.value, self.done = value, done

    def made(self, kind, value):
        self.done[kind] += 1
        return Number(value, self.done)

    def __mul__(self, other):
        return self.made("products", self.value * other.value)

    def __add__(self, other):
        return self.made("sums", self.value + other.value)

    def __sub__(self, other):
        return self.made("sums", self.value - other.value)

    def __truediv__(self, other):
        return self.made("quotients", self.value / other.value)


def product(a, b):
    """Of matrices: each element as it stands, zeros and ones too."""
    columns = list(zip(*b))
    return [[added(x * y for x, y in zip(row, column)) for column in columns] for row in a]


def added(terms):
    total, *rest = terms
    for term in rest:
        total = total + term
    return total


def plus(a, b):
    return [[x + y for x, y in zip(one, other)] for one, other in zip(a, b)]


def turned(a):
    return [list(row) for row in zip(*a)]


def kalman_in_matrices(n, phi, h, q, r, x, p, z):
    """(s, P) after a sample, n = 2, m = 1: P H' is made once, the inverse of S is a quotient."""
    x, p = product(phi, x), plus(product(product(phi, p), turned(phi)), q)
    ph = product(p, turned(h))
    s = product(h, ph)[0][0] + r
    inverse = n(1.0) / s
    gain = [[row[0] * inverse] for row in ph]
    innovation = z - product(h, x)[0][0]
    x = plus(x, [[row[0] * innovation] for row in gain])
    kept = [[one - taken for one, taken in zip(row, other)] for row, other in zip([[n(1.0), n(0.0)], [n(0.0), n(1.0)]], product(gain, h))]
    return x, product(kept, p)


def kalman_in_scalars(n, _phi, _h, q, r, x, p, z):
    """The same for T = 1, h = (1 0) and a symmetric P, element by element, as paper 000 writes its own."""
    (x, v), (p11, p12), p22 = (x[0][0], x[1][0]), p[0], p[1][1]
    x, corner = x + v, p12 + p22
    p11, p12, p22 = p11 + p12 + corner, corner, p22 + q[1][1]
    inverse = n(1.0) / (p11 + r)
    w1, w2, innovation = p11 * inverse, p12 * inverse, z - x
    x, v = x + w1 * innovation, v + w2 * innovation
    p22, p12, p11 = p22 - w2 * p12, p12 - w1 * p12, p11 - w1 * p11
    return [[x], [v]], [[p11, p12], [p12, p22]]


def algorithm_22(n, r, x, p, z):
    """Estimate and variance of (22) as printed; x and p: the last three and five, newest first."""
    p1, p2, p3, p4, p5 = p
    a1 = (n(8.0) * p3 - p1 - n(6.0) * p2 - n(2.0) * p4) / (n(8.0) * p2 + n(4.0) * p3 - n(8.0) * p4 + n(2.0) * p5)
    twice, square = n(2.0) * a1, a1 * a1
    rest, squares = n(1.0) - twice, n(2.0) * square
    expected = (n(2.0) - a1) * x[0] - rest * x[1] - a1 * x[2]
    pe = ((n(2.0) + a1) * p1 - n(2.0) * (n(2.0) - n(3.0) * a1 - squares) * p2 + (n(1.0) - n(8.0) * a1 + squares) * p3 + twice * rest * p4 +
          square * p5)
    b0 = pe / (pe + r)
    return expected + b0 * (z - expected), (n(1.0) - b0) * pe


def counts(step, *arguments):
    """({products, sums, quotients}, result) of a step; arguments: numbers and nested lists of numbers."""
    done = dict.fromkeys(("products", "sums", "quotients"), 0)

    def counting(what):
        return [counting(part) for part in what] if isinstance(what, (list, tuple)) else Number(what, done)

    found = step(lambda value: Number(value, done), *map(counting, arguments))
    return done, found


def table1(x=((3.2,), (0.01,)), p=((0.7, 0.0), (0.0, 0.04)), z=3.3):
    """Of paper 002, with T as the unit of time."""
    return ((1.0, 1.0), (0.0, 1.0)), ((1.0, 0.0),), ((0.0, 0.0), (0.0, 5.5e-7)), 0.0064, x, p, z


STEPS = {"kalman_in_matrices": (kalman_in_matrices, table1()), "kalman_in_scalars": (kalman_in_scalars, table1()),
         "printed": (algorithm_22, (0.6, (1.0, 0.9, 0.7), (5.0, 4.0, 3.5, 3.0, 2.0), 1.2))}


def rows(experiment, names):
    """Of one sample; a quotient is counted among the multiplications, as in paper 002."""
    for name in names:
        done, _ = counts(STEPS[name][0], *STEPS[name][1])
        for metric, value in (("multiplications", done["products"] + done["quotients"]), ("additions", done["sums"]),
                              ("quotients", done["quotients"])):
            yield experiment, name, "double", metric, value, 1
