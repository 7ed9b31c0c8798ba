"""Counts missing rows from the times of the received rows."""
from collections import deque
from statistics import median, median_low
from typing import NamedTuple

WINDOW = 17      # steps around the one judged, without any in which the board reported something; their median is the local row period
GAP_FROM = 1.75  # periods: one lost row makes 2.0; rows read by the clock (fault 5) are up to half a period early or late: 1.5


class Step(NamedTuple):
    us: int
    dropped: bool  # the board reports dropped rows before this one (flag 256)
    excused: bool  # one of the two rows has no sample
    spoken: bool   # the board reported something in between: a stop, a fault, a change of rate


class Gaps:
    """add() each step between two rows; cut() where the rows on both sides are unrelated."""

    def __init__(self):
        self.on_the_way = self.by_the_board = self.pauses = self.pauses_us = 0
        self.steps = deque(maxlen=WINDOW)
        self.judged = 0  # of the steps in the window

    @property
    def lost(self):
        """Lost rows, without those of the last half window before cut()."""
        return self.on_the_way + self.by_the_board

    def add(self, us, dropped=False, excused=False, spoken=False):
        if len(self.steps) == WINDOW:
            self.judged -= 1
        self.steps.append(Step(us, dropped, excused, spoken))
        if len(self.steps) == WINDOW:
            self.judge_to(WINDOW // 2 + 1)

    def cut(self):
        self.judge_to(len(self.steps))
        self.steps.clear()
        self.judged = 0

    def judge_to(self, end):
        steps = list(self.steps)
        for place in range(self.judged, end):
            self.judge(steps[place], max(1, period_us(steps, place)))
        self.judged = end

    def judge(self, step, period):
        missing = round(step.us / period) - 1 if step.us >= GAP_FROM * period else 0
        if step.dropped:
            self.by_the_board += max(1, missing)
        elif missing and (step.excused or step.spoken):
            self.pauses, self.pauses_us = self.pauses + 1, self.pauses_us + step.us
        else:
            self.on_the_way += missing


def period_us(steps, place):
    """The row period at this step. A report of the board may change it, so steps beyond one do not count; of two, the lower median."""
    if steps[place].spoken:
        return median(step.us for step in steps)
    begin = end = place
    while begin and not steps[begin - 1].spoken:
        begin -= 1
    while end < len(steps) and not steps[end].spoken:
        end += 1
    return median_low(step.us for step in steps[begin:end])
