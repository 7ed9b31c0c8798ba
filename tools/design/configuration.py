"""A filter as the fixed-point library takes it: stored values, the same legal ranges and the same stability test as the C, and what the stored
values really give. host_tests/test_design.py holds every number here to the compiled library."""
import itertools
import math
from dataclasses import dataclass, field
from fractions import Fraction

from scipy.optimize import brentq

from .structure import Filter, alpha_beta, closed_noise_gain

ONE = 65536
RATE_DHZ = (50, 40000)
R_Q8 = (3, 256000)
B0 = (656, 65535)
A1 = (-65535, 65535)
PLUS_K_MAX = 16
Q = (1, 1_000_000_000)
KF_DRIVE = (16 / 2 ** 28, 1.0)  # q T^3 / R that kf can tell apart
ROUNDING = 1e-12  # of a bound that floating point has computed
FIRMWARE_RATES_HZ = (12.5, 25, 50, 100, 200, 400, 800)


class Unfit(Exception):
    """One sentence: why the library has no such configuration."""


@dataclass
class Configuration:
    name: str  # of the filter in the library
    fields: dict  # field of NAME_config_t: stored value
    filter: Filter  # what the stored values are, exact
    notes: list = field(default_factory=list)

    def initialiser(self):
        values = ", ".join(f".{name} = {value}{'U' if value > 32767 else ''}" for name, value in self.fields.items())
        return f"static const {self.name}_config_t config = {{ {values} }};"


def common_fields(rate_hz, sigma_lsb):
    """rate_dhz and r_lsb2_q8, or why there are none."""
    rate_dhz = round(10 * rate_hz)
    if not RATE_DHZ[0] <= rate_dhz <= RATE_DHZ[1] or abs(rate_dhz - 10 * rate_hz) > 1e-6 * rate_dhz:
        raise Unfit(f"the library takes rates of 5 to 4000 Hz in steps of 0.1 Hz, not {rate_hz:g} Hz; nearest: "
                    f"{min(max(rate_dhz, RATE_DHZ[0]), RATE_DHZ[1]) / 10:g} Hz")
    r = round(256 * sigma_lsb * sigma_lsb)
    if not R_Q8[0] <= r <= R_Q8[1]:
        raise Unfit(f"the library takes a sigma of {math.sqrt(R_Q8[0] / 256):.3f} to {math.sqrt(R_Q8[1] / 256):.1f} LSB, not {sigma_lsb:.4g} LSB: "
                    f"see --lsb-per-unit")
    return {"rate_dhz": rate_dhz, "r_lsb2_q8": r}


def synth_legal(b0_uq16, a1_q16):
    """What synth_init asks of b0 and a1, in integers: 1 + 2 a1 (1 - b0) > 0."""
    if not (B0[0] <= b0_uq16 <= B0[1] and A1[0] <= a1_q16 <= A1[1]):
        return False
    return a1_q16 >= 0 or -a1_q16 * (ONE - b0_uq16) < 2 ** 31


def synth_filter(b0_uq16, a1_q16):
    return Filter(2, (Fraction(a1_q16, ONE),), (Fraction(b0_uq16, ONE),))


def worth(f, error_max, noise_max):
    """(bounds broken, what is to be least) of a stored filter, for a choice among neighbours."""
    error, noise = abs(f.dynamic_error()), f.noise_gain()
    broken = (error_max is not None and error > error_max * (1 + ROUNDING)) + (noise_max is not None and noise > noise_max * (1 + ROUNDING))
    return broken, (noise if error_max is not None else error)


def neighbours(value, low, high, reach=2):
    near = {min(max(math.floor(value) + i, low), high) for i in range(1 - reach, reach + 1)}
    return sorted(near)


def stored_synth(f, common, error_max, noise_max, fixed_a=False):
    """The stored values nearest to the filter that keep the bound and are best under it."""
    a1 = (float(f.a[0]) if f.a else 0.0) * ONE
    b0 = float(f.b[0]) * ONE
    if not B0[0] - 0.5 <= b0 <= B0[1] + 0.5:
        raise Unfit(f"synth takes b0 from {B0[0] / ONE:.5f} to {B0[1] / ONE:.5f}, not {b0 / ONE:.6g}; nearest: --b {min(max(b0, B0[0]), B0[1]) / ONE:.5f}")
    if not A1[0] - 0.5 <= a1 <= A1[1] + 0.5:
        raise Unfit(f"synth takes a1 from {A1[0] / ONE:.5f} to {A1[1] / ONE:.5f}, not {a1 / ONE:.6g}; nearest: --a {min(max(a1, A1[0]), A1[1]) / ONE:.5f}")
    if error_max is None and noise_max is None:
        chosen = (min(max(round(b0), B0[0]), B0[1]), min(max(round(a1), A1[0]), A1[1]))
        if not synth_legal(*chosen):
            raise Unfit(f"stored as b0 = {chosen[0]}, a1 = {chosen[1]} (in 1/65536) it is unstable; nearest: a larger b0")
    else:
        first = [round(a1)] if fixed_a or abs(a1) < 1e-6 else neighbours(a1, *A1)
        pairs = [pair for pair in itertools.product(neighbours(b0, *B0), first) if synth_legal(*pair)]
        chosen = min(pairs, key=lambda pair: worth(synth_filter(*pair), error_max, noise_max))
        if worth(synth_filter(*chosen), error_max, noise_max)[0]:
            raise Unfit("no values in 1/65536 near the design keep the bound; nearest: a bound 0.1 % wider")
    fields = {"rate_dhz": common["rate_dhz"], "b0_uq16": chosen[0], "a1_q16": chosen[1], "r_lsb2_q8": common["r_lsb2_q8"]}
    return Configuration("synth", fields, synth_filter(*chosen))


def plus_rho(k):
    """-a1 of synth_plus: 1 - 2^-k, 16 standing for 1."""
    return Fraction(1) if k == PLUS_K_MAX else 1 - Fraction(1, 2 ** k)


def plus_filter(k, b, v=2):
    """v = 3 is the same filter told as of astatism 3: k = 16."""
    b = tuple(Fraction(x, ONE) for x in b)
    return Filter(3, (), b) if v == 3 else Filter(2, (-plus_rho(k),) if k else (), b)


def plus_legal(k, b0_uq16, b1_q16, b2_q16):
    """What synth_plus_init asks of its coefficients."""
    if not (0 <= k <= PLUS_K_MAX and B0[0] <= b0_uq16 <= B0[1] and all(A1[0] <= b <= A1[1] for b in (b1_q16, b2_q16))):
        return False
    return plus_filter(k, (b0_uq16, b1_q16, b2_q16)).stable()


def stored_plus(f, common, error_max, noise_max):
    rho = 1.0 if f.v == 3 else -float(f.a[0]) if f.a else 0.0
    k = min(range(PLUS_K_MAX + 1), key=lambda i: abs(float(plus_rho(i)) - rho))
    if abs(float(plus_rho(k)) - rho) > 1e-6:
        raise Unfit(f"synth_plus has a1 = -(1 - 2^-k), not {-rho:.6g}; nearest: --a={-float(plus_rho(k)):.6g}")
    wanted = [float(x) * ONE for x in f.b] + [0.0] * (2 - f.l)
    ends = (B0, A1, A1)
    if not all(low - 0.5 <= x <= high + 0.5 for x, (low, high) in zip(wanted, ends)):
        raise Unfit(f"synth_plus takes b0 from {B0[0] / ONE:.5f} to {B0[1] / ONE:.5f}, b1 and b2 within {A1[1] / ONE:.5f}; nearest: a bound a little wider")
    if error_max is None and noise_max is None:
        choices = [tuple(min(max(round(x), low), high) for x, (low, high) in zip(wanted, ends))]
    else:
        choices = itertools.product(*([0] if x == 0 else neighbours(x, *end) for x, end in zip(wanted, ends)))
    stored = [b for b in choices if plus_legal(k, *b)]
    if not stored:
        raise Unfit("stored in 1/65536 it is unstable; nearest: a larger b0")
    chosen = min(stored, key=lambda b: worth(plus_filter(k, b, f.v), error_max, noise_max))
    made = plus_filter(k, chosen, f.v)
    if worth(made, error_max, noise_max)[0]:
        raise Unfit("no values in 1/65536 near the design keep the bound; nearest: a bound 0.1 % wider")
    fields = {"rate_dhz": common["rate_dhz"], "b0_uq16": chosen[0], "k": k, "b1_q16": chosen[1], "b2_q16": chosen[2], "r_lsb2_q8": common["r_lsb2_q8"]}
    return Configuration("synth_plus", fields, made)


def kalman_alpha_beta(alpha):
    """The steady Kalman filter of a white second difference with this gain: beta = alpha^2 / (2 - alpha)."""
    return alpha_beta(alpha, alpha * alpha / (2 - alpha))


def drive_of(alpha):
    """lambda = variance of the second difference per R for which the steady gain is alpha: beta^2 / (1 - alpha)."""
    beta = alpha * alpha / (2 - alpha)
    return beta * beta / (1 - alpha)


def alpha_of(drive):
    return brentq(lambda alpha: math.log(drive_of(alpha)) - math.log(drive), 1e-9, 1 - 1e-12, xtol=1e-15)


def kalman_for(error_max, noise_max):
    """The steady two-state Kalman filter that just meets a bound."""
    if error_max is not None:
        return kalman_alpha_beta(4 / (3 + math.sqrt(1 + 8 * error_max)))  # (1 - alpha) (2 - alpha) = D alpha^2
    return kalman_alpha_beta(brentq(lambda alpha: closed_noise_gain(kalman_alpha_beta(alpha)) - noise_max, 1e-15, 1 - 1e-12, xtol=1e-15))


def stored_kf(f, common, error_max, noise_max):
    """q of kf for a filter that is a steady Kalman filter, on the side that keeps the bound."""
    alpha = float(f.b[0])
    wanted = drive_of(alpha)
    if not KF_DRIVE[0] <= wanted <= KF_DRIVE[1]:
        raise Unfit(f"kf has steady gains from {alpha_of(KF_DRIVE[0]):.3f} to {alpha_of(KF_DRIVE[1]):.3f}, not {alpha:.4f}")
    per_q = (10 / common["rate_dhz"]) ** 3 / (common["r_lsb2_q8"] / 256)
    q = wanted / per_q
    if error_max is not None:
        q = math.ceil(q * (1 - ROUNDING))
    else:
        q = math.floor(q * (1 + ROUNDING)) if noise_max is not None else round(q)
    if not Q[0] <= q <= Q[1]:
        raise Unfit(f"kf takes q from {Q[0]} to {Q[1]} LSB2/s3, not {wanted / per_q:.4g}")
    if q * per_q > KF_DRIVE[1]:
        raise Unfit(f"kf has steady gains up to {alpha_of(KF_DRIVE[1]):.3f}")
    stored = kalman_alpha_beta(alpha_of(q * per_q))
    fields = {"rate_dhz": common["rate_dhz"], "r_lsb2_q8": common["r_lsb2_q8"], "q_lsb2_s3": q}
    notes = ["the gain follows R, which the firmware estimates: it is this one where the noise is the sigma given"]
    return Configuration("kf", fields, stored, notes)


def is_kalman(f, tolerance=1e-9):
    alpha, beta = float(f.b[0]), float(sum(f.b))
    return abs(beta - alpha * alpha / (2 - alpha)) <= tolerance


def configure(f, rate_hz, sigma_lsb, error_max=None, noise_max=None, fixed_a=False):
    """The configuration of the library's filter with this structure; Unfit when there is none."""
    common = common_fields(rate_hz, sigma_lsb)
    if f.v == 2 and f.k <= 1 and f.l == 0:
        return stored_synth(f, common, error_max, noise_max, fixed_a)
    if f.order == (2, 0, 1) and is_kalman(f):
        return stored_kf(f, common, error_max, noise_max)
    if f.v == 2 and f.k <= 1 and f.l in (1, 2) or f.order == (3, 0, 2):
        return stored_plus(f, common, error_max, noise_max)
    raise Unfit(f"the library has no filter with (v, k, l) = ({f.v}, {f.k}, {f.l}): synth is (2, 1, 0), synth_plus (2, 1, 2) and (3, 0, 2)")


def commands(configuration, rate_hz):
    """(lines to type, what they do not do)."""
    lines = [f"filter {configuration.name}"]
    told = [f"the firmware has no command that sets {' or '.join(n for n in configuration.fields if n != 'rate_dhz')}: `filter "
            f"{configuration.name}` runs it with the values of {configuration.name}_defaults; put the initialiser where your program calls "
            f"{configuration.name}_init"]
    if rate_hz in FIRMWARE_RATES_HZ:
        lines.insert(0, f"rate {rate_hz:g}")
    else:
        nearest = min(FIRMWARE_RATES_HZ, key=lambda r: abs(math.log(r / rate_hz)))
        told.insert(0, f"the firmware samples at {', '.join(f'{r:g}' for r in FIRMWARE_RATES_HZ)} Hz, not at {rate_hz:g} Hz; nearest: {nearest:g}")
    return lines, told
