"""A flight as records for the filter, and the answers, reassembled."""
from dataclasses import dataclass, field
from itertools import chain

import numpy as np

from tilt.errors import TiltError
from tilt.navigation import frames

VARIANCES_EVERY_US = 1_000_000
NEAR = 128  # half of the sequence numbers


@dataclass(frozen=True)
class Sent:
    """One record: its due time, its bytes as a frame, its kind, its sequence number, and its row of the flight (None: none)."""
    due_us: int
    data: bytes
    kind: str
    sequence: int
    row: int = None

    @property
    def types(self):
        """The types that an answer to it may name."""
        return "PS" if self.kind == "start" else frames.TYPES[self.kind]


def due_of(flight):
    """Due time of each imu row in microseconds after the first one. The filter has to reject a single time that jumps, so the line waits for the
    median of each three."""
    times = np.array(flight.unwrapped_us([t_us for kind, t_us, _ in flight.rows if kind == "imu"]), np.int64)
    if len(times) < 3:
        return np.maximum.accumulate(times - times[:1])
    step = int(np.median(np.diff(times)))
    middle = np.median([[times[0], *times[:-2], times[-1]], [times[1] - step, *times[1:-1], times[-2] + step],
                        [times[2] - 2 * step, *times[2:], times[-3] + 2 * step]], axis=0).astype(np.int64)
    return np.maximum.accumulate(middle - middle[0])


def records(flight, chosen, every=10):
    """All frames of a flight: start, rows, the state after every `every`-th imu, variances once a second, counts at the end."""
    out, sequence, imu, due = [], 0, 0, 0
    next_variances, dues = None, iter(due_of(flight).tolist())

    def add(record, kind, row=None):
        nonlocal sequence
        out.append(Sent(due, frames.frame(record), kind, sequence & 0xFF, row))
        sequence += 1

    for record in frames.start_records(0, flight.settings_with(chosen)):
        add(record, "start")
    for row, (kind, t_us, values) in enumerate(flight.rows):
        if kind == "imu":
            due = next(dues)
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
    """The answers: states (n, 13) at t_us, variances at theirs (imu time of the last state before), answers in order."""
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


def _place_of(answer, sent, at):
    """The record that an answer is for: the next with its number and type, or the last of earlier ones; None: none was sent. Numbers repeat."""
    near = chain(range(at, min(at + NEAR, len(sent))), range(at - 1, max(at - NEAR, 0) - 1, -1))
    return next((place for place in near if sent[place].sequence == answer.sequence and answer.kind in sent[place].types), None)


def answered(sent, answers):
    """[(record, answer)] of all answers, in order; record is None if none of those sent has the answer's number and type."""
    pairs, at = [], 0
    for answer in answers:
        place = _place_of(answer, sent, at) if answer.kind else None
        pairs.append((None if place is None else sent[place], answer))
        at = at if place is None else max(at, place + 1)
    return pairs


def refusals(sent, outcome):
    """[(record, answer)] of what was not simply accepted, in order; record is None if the board could not read which one it was."""
    return [(record, answer) for record, answer in answered(sent, outcome.answers) if answer.code != 0]


def check_start(sent, outcome):
    """TiltError if the flight never started: the filter rejects everything after that."""
    start = [record for record in sent if record.kind == "start"]
    pairs = answered(sent, outcome.answers)
    heard = {record.sequence: answer.code for record, answer in pairs if record is not None and record.kind == "start"}
    if len(heard) < len(start) and (any(heard.values()) or any(frames.answer_text(answer.code) == "not started" for answer in outcome.answers)):
        raise TiltError(f"the flight did not start: the board answered {len(heard)} of its {len(start)} start frames, the others were "
                        "lost on the line")
    for code in filter(None, heard.values()):
        raise TiltError(f"{frames.answer_text(code)}: a setting is out of range or not finite (docs/navigation.md, --set)")
