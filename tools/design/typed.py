"""The lines that set a configuration on the board, in an order in which the board accepts each whatever values it had, and the filter that they
make there: the console takes four decimals, which is coarser than what the library stores."""
import dataclasses
import itertools
import math

from . import configuration
from .configuration import FIRMWARE_RATES_HZ, KALMAN, ONE_GAIN, TAPS

DECIMALS = 10_000
NAMES = {"rate_max": "ratemax"}
# what is typed before the values, so that any b0 is stable; only a change of the filter resets its parameters
BEFORE = {ONE_GAIN: [f"filter {ONE_GAIN}", "a1 0"], TAPS: [f"filter {KALMAN[3][0]}", f"filter {TAPS}", "b1 0"]}
COEFFICIENTS = {"b0_uq16": None, "k": 0, "b1_q16": 0, "b2_q16": 0}  # of TAPS, with what it has then


def name_of(field):
    """The console's name of b0_uq16, q_lsb2_s3, rate_max_lsb_s, k."""
    word = field.split("_lsb")[0].removesuffix("_uq16").removesuffix("_q16")
    return NAMES.get(word, word)


def fraction_of(field):
    return 16 if field.endswith("q16") else 8 if field.endswith("q8") else 0


def taken(text, bits):
    """The number that the board stores (firmware/base/number.c)."""
    whole, _, decimals = text.lstrip("-").partition(".")
    divisor = 10 ** len(decimals)
    stored = (int(whole + decimals) * 2 ** bits + divisor // 2) // divisor
    return -stored if text.startswith("-") else stored


def texts(value, bits):
    """The numbers on both sides of a stored one that can be typed."""
    if not bits:
        return [str(value)]
    places = value / 2 ** bits * DECIMALS
    found = (f"{near / DECIMALS:.4f}".rstrip("0").rstrip(".") for near in (math.floor(places), math.ceil(places)))
    return list(dict.fromkeys("0" if text == "-0" else text for text in found))


def legal(name, fields):
    if name == ONE_GAIN:
        return configuration.gain_legal(fields["b0_uq16"], fields["a1_q16"])
    return name != TAPS or configuration.plus_legal(*(fields[key] for key in ("k", "b0_uq16", "b1_q16", "b2_q16")))


def filter_of(made, fields):
    """The filter of these stored values; those of a Kalman filter are typed as they are stored."""
    if made.name == ONE_GAIN:
        return configuration.gain_filter(fields["b0_uq16"], fields["a1_q16"])
    if made.name == TAPS:
        return configuration.plus_filter(fields["k"], [fields[key] for key in ("b0_uq16", "b1_q16", "b2_q16")], made.filter.v)
    return made.filter


@dataclasses.dataclass
class Typed:
    lines: list
    filter: object  # that the board runs then


def in_order(name, stored):
    """The fields in an order in which the board accepts each after those before it; None if there is no such order."""
    if name == ONE_GAIN:
        return sorted(stored, key=lambda field: field == "a1_q16")
    if name != TAPS:
        return list(stored)
    for order in itertools.permutations(COEFFICIENTS):
        now, steps = dict(COEFFICIENTS), []
        for field in order:
            now[field] = stored[field]
            steps.append(dict(now))
        if order[0] == "b0_uq16" and all(legal(name, step) for step in steps):
            return [*order, *(field for field in stored if field not in COEFFICIENTS)]
    return None


def typed(made, rate_hz, error_max, noise_max):
    """The Typed of a configuration, the best under the bound of what can be typed; None if the board cannot run it."""
    if rate_hz not in FIRMWARE_RATES_HZ:
        return None
    fields = [key for key in made.fields if key != "rate_dhz"]
    found, has = [], COEFFICIENTS if made.name == TAPS else {"a1_q16": 0}
    for each in itertools.product(*(texts(made.fields[key], fraction_of(key)) for key in fields)):
        chosen = dict(zip(fields, each))
        stored = {key: taken(text, fraction_of(key)) for key, text in chosen.items()}
        order = in_order(made.name, stored) if legal(made.name, stored) else None
        if order is not None:
            f, away = filter_of(made, stored), sum(abs(stored[key] - made.fields[key]) for key in fields)
            bounded = configuration.worth(f, error_max, noise_max) if error_max is not None or noise_max is not None else ()
            found.append(((*bounded, away), [f"{name_of(key)} {chosen[key]}" for key in order if stored[key] != 0 or key not in has], f))
    if not found:
        return None
    _, lines, f = min(found, key=lambda one: one[0])
    return Typed([f"rate {rate_hz:g}", *BEFORE.get(made.name, [f"filter {made.name}"]), *lines], f)
