"""The errors of a flight's states against the truth."""
from dataclasses import dataclass

import numpy as np

from tilt.navigation import rotation

SETTLED_S = 40.0  # the thesis' first interval: the filter finds its attitude


@dataclass
class Errors:
    """At t_s: attitude (n, 3) rotation about north, east, down in degrees; euler (n, 3) roll, pitch, heading in degrees; velocity m/s; position m."""
    t_s: np.ndarray
    attitude_deg: np.ndarray
    euler_deg: np.ndarray
    velocity_mps: np.ndarray
    position_m: np.ndarray


def errors(flight, outcome):
    """True minus computed, where both are known; None without truth."""
    if not flight.truth:
        return None
    truth_t_us = np.array(flight.unwrapped_us(flight.truth_t_us))
    state_t_us = np.array(flight.unwrapped_us([state.t_us for state in outcome.states]))
    _, at_truth, at_state = np.intersect1d(truth_t_us, state_t_us, return_indices=True)
    true, computed = np.array(flight.truth)[at_truth], outcome.numbers[at_state]
    turned = rotation.euler(true[:, :4]) - rotation.euler(rotation.normalised(computed[:, :4]))
    return Errors(truth_t_us[at_truth] * 1e-6, np.degrees(rotation.vector_between(true[:, :4], computed[:, :4])),
                  np.degrees((turned + np.pi) % (2 * np.pi) - np.pi), true[:, 4:7] - computed[:, 4:7], true[:, 7:] - computed[:, 7:10])


def intervals(flight, seconds):
    """[(name, from s, to s)]: before, during and after each time without GPS, from when the filter has settled."""
    found, at = [], SETTLED_S if seconds > 2 * SETTLED_S else 0.0
    for begin, end in flight.gps_gaps():
        if begin > at:
            found.append(("GPS", at, begin))
        found.append(("no GPS", max(begin, at), end))
        at = end + (20.0 if seconds - end > SETTLED_S else 0.0)
    if at < seconds:
        found.append(("GPS", at, seconds))
    return found


def largest(flight, found):
    """The largest error of each kind in each interval."""
    for name, begin, end in intervals(flight, float(found.t_s[-1])):
        inside = (found.t_s > begin) & (found.t_s <= end)
        if inside.any():
            euler = np.abs(found.euler_deg[inside]).max(axis=0)
            yield {"interval": name, "from_s": float(begin), "to_s": float(end), "heading_deg": float(euler[2]), "level_deg": float(euler[:2].max()),
                   "velocity_mps": float(np.linalg.norm(found.velocity_mps[inside], axis=1).max()),
                   "position_m": float(np.linalg.norm(found.position_m[inside], axis=1).max())}


def table(flight, found):
    """The largest errors as lines of text."""
    return [f"{'':<8}{'from s':>8}{'to s':>8}{'heading deg':>13}{'roll, pitch deg':>17}{'velocity m/s':>14}{'position m':>12}   (largest)",
            *("{interval:<8}{from_s:>8.0f}{to_s:>8.0f}{heading_deg:>13.2f}{level_deg:>17.2f}{velocity_mps:>14.3f}{position_m:>12.2f}".format(**row)
              for row in largest(flight, found))]
