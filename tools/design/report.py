"""The tool's report about a design: the same facts as text and as JSON."""
from dataclasses import dataclass

from .response import bandwidth, horizon, lyapunov_noise_gain, moving_error, pole_radius, settling_by_radius, step
from .structure import closed_noise_gain
from .synthesis import ordinal


def polynomial_text(p, digits=7):
    parts = []
    for power, x in enumerate(p):
        x = float(x)
        if abs(x) < 0.5 * 10 ** -digits:
            continue
        sign = ("- " if x < 0 else "+ ") if parts else ("-" if x < 0 else "")
        size = f"{abs(x):.{digits}g}"
        delay = "" if power == 0 else f"z^-{power}"
        parts.append(sign + (delay if size == "1" and delay else f"{size} {delay}".strip()))
    return " ".join(parts) or "0"


def factored_text(f):
    shape = "" if not any(abs(x) > 1e-12 for x in f.a) else f" ({polynomial_text(f.shape)})"
    return f"(1 - z^-1)^{f.v}{shape} = {polynomial_text(f.a_polynomial)}"


def algorithm_text(f):
    """The difference equation in the library's incremental form."""
    weights = [-float(x) for x in f.a_polynomial[1:]]
    terms = [(w, f"x{i + 1}") for i, w in enumerate(weights)] + [(float(w), f"u{j + 1}") for j, w in enumerate(f.b[1:])]
    text = ""
    for weight, name in terms:
        if abs(weight) < 5e-8:
            continue
        sign = "-" if weight < 0 else "+"
        term = name if abs(abs(weight) - 1) < 5e-8 else f"{abs(weight):.7g} {name}"
        text += f" {sign} {term}" if text else f"{'-' if weight < 0 else ''}{term}"
    return f"x_e = {text};  u = g - x_e;  x = x_e + {float(f.b[0]):.7g} u"


@dataclass
class Facts:
    """The properties of one filter."""

    v: int
    k: int
    l: int  # noqa: E741
    a: list
    b: list
    characteristic: list
    pole_radius: float
    noise_gain: float
    noise_gain_lyapunov: float
    noise_gain_closed_form: float
    dynamic_error: float
    dynamic_error_on_the_way: float
    overshoot: float
    peak_at_sample: int
    settled_at_sample: int
    settling_by_slowest_pole: int
    bandwidth_per_sample: float
    largest_gain: float


def facts(f):
    plain = type(f)(f.v, tuple(float(x) for x in f.a), tuple(float(x) for x in f.b))
    closed = closed_noise_gain(plain)
    wave = step(plain)
    width, largest, _ = bandwidth(plain)
    return Facts(f.v, f.k, f.l, list(plain.a), list(plain.b), [float(x) for x in plain.characteristic], pole_radius(plain),
                 float(f.exact().noise_gain()),
                 lyapunov_noise_gain(plain), closed, float(f.dynamic_error()),
                 float(abs(moving_error(plain, horizon(plain))).max()), wave.overshoot, wave.peak_at, wave.settled_at, settling_by_radius(plain),
                 width, largest)


def facts_text(one, period_s, sigma, unit, scale, at_text):
    closed = "no closed form for this order" if one.noise_gain_closed_form is None else f"closed form {one.noise_gain_closed_form:.9g}"
    peak = f"overshoot {100 * one.overshoot:.1f} % at sample {one.peak_at_sample}" if one.overshoot > 5e-4 else "no overshoot"
    lines = [
        f"stable          yes: Schur-Cohn in exact rational numbers; slowest pole {one.pole_radius:.6f}",
        f"noise gain      {one.noise_gain:.9g} ({closed}, Lyapunov {one.noise_gain_lyapunov:.9g}): sigma {sigma:.4g} -> "
        f"{sigma * one.noise_gain ** 0.5:.4g} {unit}",
        f"dynamic error   {one.dynamic_error:.6g} per {ordinal(one.v)} difference" +
        (f" = {one.dynamic_error * scale:.4g} {unit} {at_text}" if at_text else "") +
        f"; during the transient at most {one.dynamic_error_on_the_way / abs(one.dynamic_error):.3f} times that"
        if one.dynamic_error else "dynamic error   0",
        f"step            {peak}; within 2 % from sample {one.settled_at_sample} on "
        f"({one.settled_at_sample * period_s:.4g} s); slowest pole alone: {one.settling_by_slowest_pole}",
        f"frequency       -3 dB at {one.bandwidth_per_sample / period_s:.4g} Hz; largest gain {one.largest_gain:.3f}",
    ]
    return lines


def switching_text(band, found):
    filters = band.corner_filters()
    moving = [(f"a{i + 1}", i) for i, (low, high) in enumerate(band.a) if low != high] + \
             [(f"b{j}", len(band.a) + j) for j, (low, high) in enumerate(band.b) if low != high]
    each = [", ".join(f"{name} {(*filters[c].a, *filters[c].b)[place]:.4g}" for name, place in moving) for c in found.word]
    order = "; ".join(each) if len(set(each)) > 1 else each[0]
    words = {
        "safe": f"safe: stable for any sequence of parameters within the band (proved by products of up to {found.depth} corner matrices)",
        "unsafe": f"NOT safe: a disturbance does not decay if these repeat for ever: {order} "
                  "(a start-up that lowers a gain once is not switching)",
        "undecided": "undecided: the bounds lie on both sides of 1; choose a narrower band",
    }
    return [f"switching       {words[found.verdict]}",
            f"                joint spectral radius {found.low:.5f} .. {found.high:.5f}; band {band.text()}"]


def comparison_text(rows, period_s, scale, unit):
    """rows: (name, Facts or sentence)."""
    head = f"{'structure':34}{'noise gain':>11}{'dyn. error':>12}{'in ' + unit:>11}{'overshoot':>11}{'2 % from':>12}{'pole':>9}  parameters"
    lines = [head]
    for name, one in rows:
        if isinstance(one, str):
            lines.append(f"{name:34}{one}")
            continue
        values = " ".join([f"a{i + 1} = {x:.5g}" for i, x in enumerate(one.a)] + [f"b{j} = {x:.5g}" for j, x in enumerate(one.b)])
        absolute = f"{one.dynamic_error * scale:>11.4g}" if scale else f"{'-':>11}"
        lines.append(f"{name:34}{one.noise_gain:>11.5f}{one.dynamic_error:>12.5g}{absolute}{100 * one.overshoot:>10.1f}%"
                     f"{one.settled_at_sample * period_s:>10.4g} s"
                     f"{one.pole_radius:>9.4f}  {values}")
    return lines
