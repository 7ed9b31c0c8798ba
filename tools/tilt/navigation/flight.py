"""A flight: its sensor readings and, if known, the truth. In memory, as a file, and simulated.

The file consists of comma-separated lines; lines that begin with '#' are skipped:

    set,NAME,NUMBER[,NUMBER...]                   a setting of the filter (settings.py)
    start,t_us,q0,q1,q2,q3,vn,ve,vd,rn,re,rd      where the filter starts
    imu,t_us,wx,wy,wz,fx,fy,fz                    rad/s and m/s2 in b, over the period that ends at t_us
    field,t_us,x,y,z                              magnetometer in b, any unit
    gps,t_us,vn,ve,vd,rn,re,rd                    m/s and m at t_us; in the file where it arrived
    down,t_us,metre                               altimeter: position down
    truth,t_us,q0,q1,q2,q3,vn,ve,vd,rn,re,rd

Numbers may be nan or inf: the filter has to reject them.
"""
import re
from dataclasses import dataclass, field

import numpy as np

from tilt.errors import TiltError, at
from tilt.navigation import rotation, settings
from tilt.numbers import real

WIDTHS = {"start": 10, "imu": 6, "field": 3, "gps": 6, "down": 1, "truth": 10}
T_US_MAX, CLOCK_US = 0xFFFFFFFF, 1 << 32


@dataclass
class Flight:
    """rows: (kind, t_us, numbers) in order of arrival, without start and truth; lines: in the file, one per row."""
    settings: dict = field(default_factory=dict)
    rows: list = field(default_factory=list)
    lines: list = field(default_factory=list)
    truth_t_us: list = field(default_factory=list)
    truth: list = field(default_factory=list)

    def settings_with(self, chosen=()):
        """All settings that the filter starts with: the defaults, those of the flight, and those chosen."""
        return {**settings.DEFAULTS, **self.settings, **dict(chosen)}

    def unwrapped_us(self, times_us):
        """Times of the 32-bit clock, in order except for single ones, as integers that continue after its wrap; from the first imu's on."""
        last, found = next((t_us for kind, t_us, _ in self.rows if kind == "imu"), 0), []
        for t_us in times_us:
            found.append(last + (t_us - last + CLOCK_US // 2) % CLOCK_US - CLOCK_US // 2)
            last = max(last, found[-1])
        return found

    def seconds_of(self, wanted):
        """Times of the rows of this kind."""
        times = self.unwrapped_us([t_us for _, t_us, _ in self.rows])
        return [t_us * 1e-6 for t_us, (kind, _, _) in zip(times, self.rows) if kind == wanted]

    @property
    def seconds(self):
        imu = self.seconds_of("imu")
        return imu[-1] - imu[0] if imu else 0.0

    def gps_gaps(self, longer_than_s=2.5):
        """[(from s, to s)] without GPS."""
        imu = self.seconds_of("imu")
        edges = [imu[0], *self.seconds_of("gps"), imu[-1]] if imu else []
        return [(a, b) for a, b in zip(edges, edges[1:]) if b - a > longer_than_s]


# --- the file ---------------------------------------------------------------------------------------------------------


def _number(text, path, line):
    try:
        return real(text)
    except ValueError as why:
        raise at(path, line, str(why)) from None


def _take_setting(flight, words, path, line):
    values = [_number(word, path, line) for word in words[2:]]
    try:
        flight.settings[words[1]] = settings.field_of(words[1], values)
    except (TiltError, IndexError) as why:
        raise at(path, line, str(why) if isinstance(why, TiltError) else "set needs a name and numbers") from None


def _take_row(flight, words, path, line):
    kind = words[0]
    if kind not in WIDTHS:
        raise at(path, line, f"unknown kind of row '{kind[:20]}': use set {' '.join(WIDTHS)}")
    if len(words) != 2 + WIDTHS[kind]:
        raise at(path, line, f"{kind} needs {2 + WIDTHS[kind]} fields, not {len(words)}")
    if not re.fullmatch(r"[0-9]{1,10}", words[1].strip()) or int(words[1]) > T_US_MAX:
        raise at(path, line, f"t_us must be a whole number from 0 to {T_US_MAX}, not '{words[1][:20]}'")
    t_us, values = int(words[1]), tuple(_number(word, path, line) for word in words[2:])
    if kind == "start":
        flight.settings |= {"quaternion": values[:4], "velocity_mps": values[4:7], "position_m": values[7:]}
    elif kind == "truth":
        flight.truth_t_us.append(t_us)
        flight.truth.append(values)
    else:
        flight.rows.append((kind, t_us, values))
        flight.lines.append(line)


def read(path, progress=lambda done, whole: None):
    """TiltError FILE:LINE: reason for a file that cannot be read."""
    flight = Flight()
    try:
        with open(path, encoding="utf-8") as file:
            size, done = file.seek(0, 2), 0
            file.seek(0)
            for line, text in enumerate(file, 1):
                done += len(text)
                if line % 4096 == 0:
                    progress(done, size)
                words = text.strip().split(",")
                if words == [""] or text.startswith("#"):
                    continue
                (_take_setting if words[0] == "set" else _take_row)(flight, words, path, line)
    except OSError as why:
        raise TiltError(f"{path}: {why.strerror}") from why
    except UnicodeDecodeError as why:
        raise TiltError(f"{path}: not text: {why.reason} at byte {why.start}") from why
    if not any(kind == "imu" for kind, _, _ in flight.rows):
        raise TiltError(f"{path}: no imu row")
    return flight


def _text(values):
    return ",".join(f"{value:.9g}" for value in values)


def write(path, flight, comment=""):
    try:
        with open(path, "w", encoding="utf-8") as file:
            for line in comment.splitlines():
                file.write(f"# {line}\n")
            for name, value in flight.settings.items():
                if name not in ("quaternion", "velocity_mps", "position_m"):
                    file.write(f"set,{name},{_text(value if isinstance(value, tuple) else (value,))}\n")
            begin = flight.settings_with()
            file.write(f"start,0,{_text((*begin['quaternion'], *begin['velocity_mps'], *begin['position_m']))}\n")
            truth = iter(zip(flight.truth_t_us, flight.truth))
            known = next(truth, None)
            for kind, t_us, values in flight.rows:
                while known and known[0] < t_us:
                    file.write(f"truth,{known[0]},{_text(known[1])}\n")
                    known = next(truth, None)
                file.write(f"{kind},{t_us},{_text(values)}\n")
            while known:
                file.write(f"truth,{known[0]},{_text(known[1])}\n")
                known = next(truth, None)
    except OSError as why:
        raise TiltError(f"{path}: {why.strerror}") from why


# --- simulated --------------------------------------------------------------------------------------------------------

TURN_S, SPEED_MPS, BANK_RAD, GRAVITY = 300.0, 6.0, 0.3, 9.81
RATE_NOISE, FORCE_NOISE = 6e-3, 2e-2
FIELD_NOISE, VELOCITY_NOISE, POSITION_NOISE, DOWN_NOISE = 0.0349, 0.1, 5.0, 1.0
DRIFT_RPS = (7.5e-4, -8.5e-4, 5.0e-4)
START_TURN = (1.0, 0.05, -0.05, 0.05)  # the filter starts rotated by this from the truth
START_SCALE = 1.01                     # and with velocity and position too large by this factor
FIELD_EVERY, EPOCH_EVERY, PERIOD_US = 10, 100, 10_000


@dataclass(frozen=True)
class Wish:
    """What to simulate: lengths in seconds; without: intervals without GPS; late_us: delay of each GPS epoch."""
    seconds: float = 500.0
    seed: int = 7
    drift: bool = True
    without: tuple = ((160.0, 400.0),)
    late_us: int = 0


def true_motion(t_s):
    """The flight of the thesis (section 3.4): quaternion, velocity, position, acceleration in n, rate in b, each along the last axis."""
    t_s = np.asarray(t_s, float)
    turn = 2 * np.pi / TURN_S
    heading, bank = turn * t_s, BANK_RAD * np.sin(10 * turn * t_s)
    radius, zero = SPEED_MPS * TURN_S / (2 * np.pi), np.zeros_like(t_s)
    position = np.stack([-radius * np.sin(heading), radius * np.cos(heading), zero], axis=-1)
    velocity = np.stack([-SPEED_MPS * np.cos(heading), -SPEED_MPS * np.sin(heading), zero], axis=-1)
    acceleration = turn * SPEED_MPS * np.stack([np.sin(heading), -np.cos(heading), zero], axis=-1)
    rate = np.stack([10 * BANK_RAD * turn * np.cos(10 * turn * t_s), turn * np.sin(bank), turn * np.cos(bank)], axis=-1)
    return rotation.of_euler(bank, 0.0, heading), velocity, position, acceleration, rate


def in_body(quaternion, vector):
    return np.einsum("...ji,...j->...i", rotation.matrix(quaternion), vector)


def measured(wish):
    """Each sensor's readings at each IMU time, with noise, in single precision as on the line: {kind: (steps, width)}, and the truth
    (steps, 10)."""
    random, steps = np.random.default_rng(wish.seed), int(round(wish.seconds * 1e6 / PERIOD_US))
    step = np.arange(1, steps + 1)
    between, here = true_motion((step - 0.5) * PERIOD_US * 1e-6), true_motion(step * PERIOD_US * 1e-6)
    drift = np.array(DRIFT_RPS) * wish.drift
    rate = between[4] + drift + RATE_NOISE * random.standard_normal((steps, 3))
    force = in_body(between[0], between[3] - np.array([0.0, 0.0, GRAVITY])) + FORCE_NOISE * random.standard_normal((steps, 3))
    field = np.array(settings.DEFAULTS["field"])
    seen = in_body(here[0], field / np.linalg.norm(field)) + FIELD_NOISE * random.standard_normal((steps, 3))
    velocity = here[1] + VELOCITY_NOISE * random.standard_normal((steps, 3))
    position = here[2] + POSITION_NOISE * random.standard_normal((steps, 3))
    down = here[2][:, 2:] + DOWN_NOISE * random.standard_normal((steps, 1))
    said = {"imu": np.hstack([rate, force]), "field": seen, "gps": np.hstack([velocity, position]), "down": down}
    return {kind: values.astype(np.float32) for kind, values in said.items()}, np.hstack(here[:3])


def start_of():
    quaternion, velocity, position = (np.squeeze(part) for part in true_motion(0.0)[:3])
    begin = rotation.product(quaternion, rotation.normalised(START_TURN))
    return {"quaternion": tuple(begin), "velocity_mps": tuple(START_SCALE * velocity), "position_m": tuple(START_SCALE * position)}


def simulated(wish):
    said, truth = measured(wish)
    flight, late = Flight(settings=start_of()), wish.late_us // PERIOD_US
    waiting = []

    def put(kind, step):
        flight.rows.append((kind, int(step * PERIOD_US), tuple(said[kind][step - 1].tolist())))

    for step in range(1, len(truth) + 1):
        put("imu", step)
        if step % FIELD_EVERY == 0:
            put("field", step)
        if step % EPOCH_EVERY == 0:
            if not any(a < step * PERIOD_US * 1e-6 < b for a, b in wish.without):
                waiting.append(step)
            put("down", step)
        if waiting and waiting[0] + late <= step:
            put("gps", waiting.pop(0))
        if step % FIELD_EVERY == 0:
            flight.truth_t_us.append(int(step * PERIOD_US))
            flight.truth.append(tuple(truth[step - 1].tolist()))
    return flight
