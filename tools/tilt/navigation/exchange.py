"""A flight as records for the filter, and what came back, put together again."""
from dataclasses import dataclass, field

import numpy as np

from tilt.navigation import frames, settings

VARIANCES_EVERY_US = 1_000_000


@dataclass(frozen=True)
class Sent:
    """One record: when it is due, its bytes as a frame, its kind, and which row of the flight it is (None: none)."""
    due_us: int
    data: bytes
    kind: str
    row: int = None


def records(flight, chosen, every=10):
    """All frames of a flight: start, rows, each `every`-th imu with the state after it, variances once a second, counts at the end."""
    out, sequence, imu, first, due = [], 0, 0, None, 0
    next_variances = None

    def add(record, kind, row=None):
        nonlocal sequence
        out.append(Sent(due, frames.frame(record), kind, row))
        sequence += 1

    for record in frames.start_records(0, {**settings.DEFAULTS, **flight.settings, **chosen}):
        add(record, "start")
    for row, (kind, t_us, values) in enumerate(flight.rows):
        if kind == "imu":
            first = t_us if first is None else first
            due = max(due, (t_us - first) & 0xFFFFFFFF if (t_us - first) & 0xFFFFFFFF < 1 << 31 else due)
            imu += 1
        add(frames.row_record(sequence, kind, t_us, values, kind == "imu" and imu % every == 0), kind, row)
        next_variances = due + VARIANCES_EVERY_US if next_variances is None else next_variances
        if kind == "imu" and due >= next_variances:
            add(frames.bare_record(sequence, "variances"), "variances")
            next_variances += VARIANCES_EVERY_US
    add(frames.bare_record(sequence, "counts"), "counts")
    return out


@dataclass
class Outcome:
    """What came back: states (n, 13) at t_us, variances at theirs (imu time of the last state before), answers in order."""
    states: list = field(default_factory=list)
    variances: list = field(default_factory=list)
    answers: list = field(default_factory=list)
    hellos: list = field(default_factory=list)
    counts: dict = field(default_factory=dict)
    damaged: int = 0
    healthy: bool = True

    def take(self, found):
        for item in found:
            if isinstance(item, frames.State):
                self.states.append(item)
            elif isinstance(item, frames.Variances):
                self.variances.append((self.states[-1].t_us if self.states else 0, item.numbers))
                self.healthy = self.healthy and item.healthy
            elif isinstance(item, frames.Answer):
                self.answers.append(item)
            elif isinstance(item, frames.Hello):
                self.hellos.append(item)
            else:
                self.counts = item.counted

    @property
    def t_s(self):
        return np.unwrap(np.array([state.t_us for state in self.states], float), period=2.0**32) * 1e-6

    @property
    def numbers(self):
        return np.array([state.numbers for state in self.states], float).reshape(-1, frames.STATE_NUMBERS)

    def sigmas(self):
        """t_s and (n, states): 1 sigma of position, velocity, attitude (and drift)."""
        if not self.variances:
            return np.zeros(0), np.zeros((0, 9))
        t_s = np.unwrap(np.array([t_us for t_us, _ in self.variances], float), period=2.0**32) * 1e-6
        return t_s, np.sqrt(np.maximum(np.array([numbers for _, numbers in self.variances], float), 0.0))


def refusals(sent, outcome):
    """[(record, answer)] of what was not simply taken, in order; records and answers go together one to one."""
    return [(record, answer) for record, answer in zip(sent, outcome.answers) if answer.code != 0]
