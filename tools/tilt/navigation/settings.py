"""The settings that the filter starts with: the fields of nav_config_t (nav/lib/nav.h), in its order."""
from tilt.errors import TiltError
from tilt.numbers import real

# the thesis' simulation (section 3.4), with twice its process noise: its own is half of its sensors' (docs/navigation.md)
DEFAULTS = {
    "quaternion": (1.0, 0.0, 0.0, 0.0), "velocity_mps": (0.0,) * 3, "position_m": (0.0,) * 3, "gyro_drift_rps": (0.0,) * 3,
    "field": (17818.0, 1951.0, 41847.0), "gravity_mps2": 9.81,
    "start_position_m": 57.3, "start_velocity_mps": 1.2, "start_attitude_rad": 0.02, "start_drift_rps": 1e-3,
    "walk_position_m": 1e-6, "walk_velocity_mps": 2e-4, "walk_attitude_rad": 6e-5, "walk_drift_rps": 0.0,
    "sigma_field": 0.0349, "sigma_gps_velocity_mps": 0.1, "sigma_gps_position_m": 5.0, "sigma_down_m": 1.0,
    "gate": 5.0, "period_us": 10000,
}

PERIOD_US_MAX = 0xFFFFFFFF  # limit of a record; the filter's own limit is lower


def width(name):
    """How many numbers the field has."""
    value = DEFAULTS[name]
    return len(value) if isinstance(value, tuple) else 1


def field_of(name, values):
    """The values of a field, in the form of DEFAULTS; TiltError for an unknown name or a wrong count."""
    if name not in DEFAULTS:
        raise TiltError(f"no setting '{name}': choose from {' '.join(DEFAULTS)}")
    if len(values) != width(name):
        raise TiltError(f"{name} needs {width(name)} numbers, not {len(values)}")
    if name == "period_us":
        if not 0 <= values[0] <= PERIOD_US_MAX or values[0] % 1 != 0:
            raise TiltError(f"period_us must be a whole number from 0 to {PERIOD_US_MAX}, not {values[0]:g}")
        return int(values[0])
    return tuple(values) if width(name) > 1 else values[0]


def of_option(text):
    """(name, value) of NAME=NUMBER[,NUMBER...]."""
    name, equals, numbers = text.partition("=")
    try:
        values = [real(number) for number in numbers.split(",")] if equals else None
    except ValueError:
        values = None
    if values is None:
        raise TiltError(f"--set needs NAME=NUMBER[,NUMBER...], not '{text}'")
    return name, field_of(name, values)
