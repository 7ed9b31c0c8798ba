"""A filter in the form of the fixed-point library: stored values, with the legal ranges and the stability test of the C code, and the
properties of the stored values. host_tests/tools/design/test_design.py compares every number here with the compiled library."""
import cmath
import itertools
import math
import pathlib
import re
from dataclasses import dataclass, field
from fractions import Fraction

from scipy.optimize import brentq

from .structure import Filter, difference, product

ONE = 65536
RATE_DHZ = (50, 40000)
R_Q8 = (3, 256000)
B0 = (656, 65535)
A1 = (-65535, 65535)
PLUS_K_MAX = 8
Q = (1, 1_000_000_000)
ONE_GAIN, TAPS = "synth", "synth_plus"
# by the order of astatism: name, the field of its q and that field's power of the period
KALMAN = {2: ("kf", "q_lsb2_s3", 3), 3: ("kf3", "q_lsb2_s5", 5)}
THREE_FINE_FROM_DHZ = 1000  # the unit of the acceleration changes here
OPT_LIMITS = ((0.0, 2 / 3), (-1 / 6, 11 / 13))  # of synth_opt: exact, variant U
START_RATE_LSB_S, P0_Q8_MAX = 200, 25_600_000
RATE_MAX_LSB_S = 1_000_000  # the largest, which only steps over most of the range reach: a design is linear
IMAGES = pathlib.Path(__file__).resolve().parents[2] / "mk" / "images.mk"
ROUNDING = 1e-12  # of a bound computed in floating point
FIRMWARE_RATES_HZ = (12.5, 25, 50, 100, 200, 400, 800)


class Unfit(Exception):
    """One sentence: why the library has no such configuration."""


@dataclass
class Configuration:
    name: str  # of the filter in the library
    fields: dict  # rate_dhz and, by the end of NAME_... in filter.h, parameters: stored value
    filter: Filter  # the exact filter of the stored values
    notes: list = field(default_factory=list)

    def initialiser(self):
        values = ", ".join(f"[{self.name.upper()}_{name.upper()}] = {value}" for name, value in self.fields.items() if name != "rate_dhz")
        return f"static const filter_config_t config = {{ .rate_dhz = {self.fields['rate_dhz']}, .value = {{ {values} }} }};"


def common_fields(rate_hz, sigma_lsb):
    """rate_dhz and r_lsb2_q8; Unfit if there are none."""
    rate_dhz = round(10 * rate_hz)
    if not RATE_DHZ[0] <= rate_dhz <= RATE_DHZ[1] or abs(rate_dhz - 10 * rate_hz) > 1e-6 * rate_dhz:
        raise Unfit(f"the library takes rates of 5 to 4000 Hz in steps of 0.1 Hz, not {rate_hz:g} Hz; nearest: "
                    f"{min(max(rate_dhz, RATE_DHZ[0]), RATE_DHZ[1]) / 10:g} Hz")
    r = round(256 * sigma_lsb * sigma_lsb)
    if not R_Q8[0] <= r <= R_Q8[1]:
        raise Unfit(f"the library takes a sigma of {math.sqrt(R_Q8[0] / 256):.3f} to {math.sqrt(R_Q8[1] / 256):.1f} LSB, not {sigma_lsb:.4g} LSB: "
                    f"see --lsb-per-unit")
    return {"rate_dhz": rate_dhz, "r_lsb2_q8": r}


def gain_legal(b0_uq16, a1_q16):
    """The condition of synth on b0 and a1, in integers: 1 + 2 a1 (1 - b0) > 0."""
    if not (B0[0] <= b0_uq16 <= B0[1] and A1[0] <= a1_q16 <= A1[1]):
        return False
    return a1_q16 >= 0 or -a1_q16 * (ONE - b0_uq16) < 2 ** 31


def gain_filter(b0_uq16, a1_q16):
    return Filter(2, (Fraction(a1_q16, ONE),), (Fraction(b0_uq16, ONE),))


def worth(f, error_max, noise_max):
    """(bounds broken, value to minimise) of a stored filter, to choose among neighbours."""
    error, noise = abs(f.dynamic_error()), f.noise_gain()
    broken = (error_max is not None and error > error_max * (1 + ROUNDING)) + (noise_max is not None and noise > noise_max * (1 + ROUNDING))
    return broken, (noise if error_max is not None else error)


def neighbours(value, low, high, reach=2):
    near = {min(max(math.floor(value) + i, low), high) for i in range(1 - reach, reach + 1)}
    return sorted(near)


def stored_gain(f, common, error_max, noise_max, fixed_a=False):
    """The stored values nearest to the filter that keep the bound and are best under it."""
    a1 = (float(f.a[0]) if f.a else 0.0) * ONE
    b0 = float(f.b[0]) * ONE
    if not B0[0] - 0.5 <= b0 <= B0[1] + 0.5:
        raise Unfit(f"synth takes b0 from {B0[0] / ONE:.5f} to {B0[1] / ONE:.5f}, not {b0 / ONE:.6g}; "
                    f"nearest: --b {min(max(b0, B0[0]), B0[1]) / ONE:.5f}")
    if not A1[0] - 0.5 <= a1 <= A1[1] + 0.5:
        raise Unfit(f"synth takes a1 from {A1[0] / ONE:.5f} to {A1[1] / ONE:.5f}, not {a1 / ONE:.6g}; "
                    f"nearest: --a={min(max(a1, A1[0]), A1[1]) / ONE:.5f}")
    if error_max is None and noise_max is None:
        chosen = (min(max(round(b0), B0[0]), B0[1]), min(max(round(a1), A1[0]), A1[1]))
        if not gain_legal(*chosen):
            raise Unfit(f"stored as b0 = {chosen[0]}, a1 = {chosen[1]} (in 1/65536) the filter is unstable; nearest: a larger b0")
    else:
        first = [round(a1)] if fixed_a or abs(a1) < 1e-6 else neighbours(a1, *A1)
        pairs = [pair for pair in itertools.product(neighbours(b0, *B0), first) if gain_legal(*pair)]
        chosen = min(pairs, key=lambda pair: worth(gain_filter(*pair), error_max, noise_max))
        if worth(gain_filter(*chosen), error_max, noise_max)[0]:
            raise Unfit("no values in 1/65536 near the design keep the bound; nearest: a bound 0.1 % wider")
    fields = {"rate_dhz": common["rate_dhz"], "b0_uq16": chosen[0], "a1_q16": chosen[1], "r_lsb2_q8": common["r_lsb2_q8"],
              "rate_max_lsb_s": RATE_MAX_LSB_S}
    return Configuration(ONE_GAIN, fields, gain_filter(*chosen))


def plus_rho(k):
    """-a1 of synth_plus: 1 - 2^-k, 8 standing for 1."""
    return Fraction(1) if k == PLUS_K_MAX else 1 - Fraction(1, 2 ** k)


def plus_filter(k, b, v=2):
    """v = 3: the same filter, expressed with astatism 3: k = 8."""
    b = tuple(Fraction(x, ONE) for x in b)
    return Filter(3, (), b) if v == 3 else Filter(2, (-plus_rho(k),) if k else (), b)


def plus_legal(k, b0_uq16, b1_q16, b2_q16):
    """The conditions of synth_plus on its coefficients."""
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
        raise Unfit(f"synth_plus takes b0 from {B0[0] / ONE:.5f} to {B0[1] / ONE:.5f}, b1 and b2 within {A1[1] / ONE:.5f}; "
                    f"nearest: a bound a little wider")
    if error_max is None and noise_max is None:
        choices = [tuple(min(max(round(x), low), high) for x, (low, high) in zip(wanted, ends))]
    else:
        choices = itertools.product(*([0] if x == 0 else neighbours(x, *end) for x, end in zip(wanted, ends)))
    stored = [b for b in choices if plus_legal(k, *b)]
    if not stored:
        raise Unfit("stored in 1/65536 the filter is unstable; nearest: a larger b0")
    chosen = min(stored, key=lambda b: worth(plus_filter(k, b, f.v), error_max, noise_max))
    made = plus_filter(k, chosen, f.v)
    if worth(made, error_max, noise_max)[0]:
        raise Unfit("no values in 1/65536 near the design keep the bound; nearest: a bound 0.1 % wider")
    fields = {"rate_dhz": common["rate_dhz"], "b0_uq16": chosen[0], "k": k, "b1_q16": chosen[1], "b2_q16": chosen[2],
              "r_lsb2_q8": common["r_lsb2_q8"]}
    return Configuration(TAPS, fields, made)


def stored_opt(f, common):
    """synth_opt, if the filter is the limit of one of its schedules."""
    a1, b0 = (float(f.a[0]) if f.a else 0.0), float(f.b[0])
    variant = next((u for u, limit in enumerate(OPT_LIMITS) if abs(a1 - limit[0]) < 1e-3 and abs(b0 - limit[1]) < 1e-3), None)
    if variant is None:
        raise Unfit("synth_opt ends at (a1, b0) = (0, 2/3) or (-1/6, 11/13) for any R")
    period_s, r = 10 / common["rate_dhz"], common["r_lsb2_q8"]
    start = min(max(round(256 * (2 * START_RATE_LSB_S * period_s) ** 2 + 0.29 * r), 3), P0_Q8_MAX)
    stored = gain_filter(*((43691, 0), (55454, -10923))[variant])
    notes = [f"P0 for an axis that starts at {START_RATE_LSB_S} LSB/s, as shipped; `schedule` shows the gains of the start"]
    fields = {"rate_dhz": common["rate_dhz"], "variant_u": variant, "p0_lsb2_q8": start, "r_lsb2_q8": r, "rate_max_lsb_s": RATE_MAX_LSB_S}
    return Configuration("synth_opt", fields, stored, notes)


def steady_kalman(v, drive):
    """The steady Kalman filter of a white v-th difference with variance drive R. Its poles are the zeros of A(z) A(1/z) + drive inside the
    circle: with y = (1 - z) (1 - 1/z), y^v = -drive, z + 1/z = 2 - y. The last coefficient of C is that of A times 1 - b0."""
    c = [1.0]
    for m in range(v):
        half = 1 - drive ** (1 / v) * cmath.exp(1j * math.pi * (2 * m + 1) / v) / 2
        pole = half - cmath.sqrt(half * half - 1)
        pole = pole if abs(pole) < 1 else 1 / pole
        c = product(c, [1.0, -pole])
    c = [x.real for x in map(complex, c)]
    kept = abs(c[-1])  # 1 - b0
    return Filter(v, (), tuple(x - kept * y for x, y in zip(c, difference(v)))[:v])


def kalman_for(v, error_max, noise_max):
    """The steady Kalman filter of a white v-th difference that just meets a bound."""

    def excess(log_drive):
        f = steady_kalman(v, math.exp(log_drive))
        return math.log(f.dynamic_error() / error_max) if error_max is not None else math.log(noise_max / f.noise_gain())

    ends = (math.log(1e-14), math.log(1e6))
    if excess(ends[0]) < 0 or excess(ends[1]) > 0:
        raise Unfit("no steady Kalman filter between drives of 1e-14 and 1e6 R meets the bound")
    return steady_kalman(v, math.exp(brentq(excess, *ends, xtol=1e-13)))


def drive_of(f):
    """Variance of the white v-th difference per R: C(1)^2 = B(1)^2 in units of 1 / (1 - b0)."""
    return float(sum(f.b)) ** 2 / (1 - float(f.b[0]))


def is_kalman(f, tolerance=1e-7):
    if f.k or f.l != f.v - 1:
        return False
    return max(abs(float(x) - y) for x, y in zip(f.b, steady_kalman(f.v, drive_of(f)).b)) <= tolerance


def stored_kf(f, common, error_max, noise_max):
    """q of kf or kf3 for a steady Kalman filter, on the side that keeps the bound."""
    name, field_name, power_of_period = KALMAN[f.v]
    low, high = drive_range(f.v, common["rate_dhz"])
    wanted = drive_of(f)
    per_q = (10 / common["rate_dhz"]) ** power_of_period / (common["r_lsb2_q8"] / 256)
    q = wanted / per_q
    if error_max is not None:
        q = math.ceil(q * (1 - 1e-9))
    else:
        q = math.floor(q * (1 + 1e-9)) if noise_max is not None else round(q)
    if not (low <= wanted <= high and low <= q * per_q <= high):
        raise Unfit(f"{name} at {common['rate_dhz'] / 10:g} Hz has steady gains from {float(steady_kalman(f.v, low).b[0]):.3f} to "
                    f"{float(steady_kalman(f.v, high).b[0]):.3f}, not {float(f.b[0]):.4f}")
    if not Q[0] <= q <= Q[1]:
        raise Unfit(f"{name} takes q from {Q[0]} to {Q[1]}, not {wanted / per_q:.4g}")
    fields = {"rate_dhz": common["rate_dhz"], "r_lsb2_q8": common["r_lsb2_q8"], field_name: q}
    return Configuration(name, fields, steady_kalman(f.v, q * per_q))


def drive_range(v, rate_dhz):
    """Drives (q T^3 / R, kf3: q T^5 / R) that the filter does not limit."""
    if v == 2:
        return 4 / 2 ** 26, 14.0  # lib/filters/src/kalman.h
    return (2.0 ** -24, 1.0) if rate_dhz < THREE_FINE_FROM_DHZ else (2.0 ** -32, 2.0 ** -11)


def configure(f, rate_hz, sigma_lsb, error_max=None, noise_max=None, fixed_a=False):
    """The configuration of the library's filter with this structure; Unfit if there is none."""
    common = common_fields(rate_hz, sigma_lsb)
    if f.v == 2 and f.k <= 1 and f.l == 0:
        return stored_gain(f, common, error_max, noise_max, fixed_a)
    if f.v in (2, 3) and is_kalman(f):
        return stored_kf(f, common, error_max, noise_max)
    if f.v == 2 and f.k <= 1 and f.l in (1, 2) or f.order == (3, 0, 2):
        return stored_plus(f, common, error_max, noise_max)
    raise Unfit(f"the library has no filter with (v, k, l) = ({f.v}, {f.k}, {f.l}): synth is (2, 1, 0), synth_plus (2, 1, 2) and (3, 0, 2)")


def image_with(name):
    """How to get a firmware image with this filter."""
    sets = re.findall(r"^FILTERS_([a-z]+) *:= *(.*)$", IMAGES.read_text(encoding="utf-8") if IMAGES.is_file() else "", re.M)
    holding = [word for word, names in sets if name in names.split()]
    if holding:
        return f"in the image that `make flash FILTERS={holding[0]}` builds and writes"
    return f"in no image as shipped: `make flash FILTERS={name}` builds one and writes it"


def notes_of(configuration, rate_hz, lines):
    """What the lines to type do not say; lines: none if the board cannot run the configuration."""
    notes = [f"{configuration.name} is {image_with(configuration.name)}; in a program of your own give the initialiser to filter_init with "
             f"filter_law_{configuration.name}"]
    if lines:
        by_noise = configuration.name in [name for name, _, _ in KALMAN.values()]
        return ["the gain follows R: `r` fixes it; leave that line out and the board estimates it"] * by_noise + notes
    nearest = min(FIRMWARE_RATES_HZ, key=lambda r: abs(math.log(r / rate_hz)))
    if rate_hz not in FIRMWARE_RATES_HZ:
        return [f"nothing to type: the firmware samples at {', '.join(f'{r:g}' for r in FIRMWARE_RATES_HZ)} Hz, not at {rate_hz:g} Hz; "
                f"nearest: --rate {nearest:g}"] + notes
    return ["nothing to type: no order in which the board accepts the values, one after the other"] + notes
