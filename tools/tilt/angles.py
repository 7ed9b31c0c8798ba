"""Roll and pitch in degrees, as lib/tilt has them: -180 < roll <= 180, -90 <= pitch <= 90."""
import numpy as np

ANGLES = ("roll", "pitch")


def raw_angles_deg(lsb):
    """{"roll", "pitch"} of readings (rows, 3)."""
    x, y, z = np.asarray(lsb, float).T
    return {"roll": np.degrees(np.arctan2(y, z)), "pitch": np.degrees(np.arctan2(-x, np.hypot(y, z)))}


def wrapped_deg(difference):
    """-180 <= result < 180"""
    return (difference + 180.0) % 360.0 - 180.0


def seam_crossings(series_deg):
    """True at rows that lie on the other side of the +-180 seam than the row before."""
    with np.errstate(invalid="ignore"):
        return np.concatenate(([False], np.abs(np.diff(series_deg)) > 180.0))
