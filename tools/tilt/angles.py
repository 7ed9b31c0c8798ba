"""Roll and pitch in degrees, as lib/tilt has them: -180 < roll <= 180, -90 <= pitch <= 90."""
import numpy as np

ANGLES = ("roll", "pitch")
LSB_PER_G = np.array([265.0, 265.0, 256.0])  # typical at 3.3 V, data sheet p. 33; also the firmware's default


def of_readings(x, y, z):
    """(roll, pitch) of accelerations in any unit."""
    x, y, z = (np.asarray(axis, float) for axis in (x, y, z))
    return np.degrees(np.arctan2(y, z)), np.degrees(np.arctan2(-x, np.hypot(y, z)))


def raw_angles_deg(lsb):
    """{"roll", "pitch"} of readings (rows, 3) in LSB of a typical sensor."""
    return dict(zip(ANGLES, of_readings(*(np.asarray(lsb, float) / LSB_PER_G).T)))


def wrapped_deg(difference):
    """-180 <= result < 180"""
    return (difference + 180.0) % 360.0 - 180.0


def seam_crossings(series_deg):
    """True at rows across the +-180 seam from the row before."""
    with np.errstate(invalid="ignore"):
        return np.concatenate(([False], np.abs(np.diff(series_deg)) > 180.0))


def direction(roll_deg, pitch_deg):
    """Unit vectors of gravity, x y z, at these angles."""
    roll, pitch = np.radians(roll_deg), np.radians(pitch_deg)
    return np.stack([-np.sin(pitch), np.cos(pitch) * np.sin(roll), np.cos(pitch) * np.cos(roll)], axis=-1)


def angle_deg(a, b):
    """Angle between unit vectors; exact for small angles too."""
    return np.degrees(2.0 * np.arcsin(np.minimum(1.0, 0.5 * np.linalg.norm(a - b, axis=-1))))
