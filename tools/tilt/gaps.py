"""Rows that are missing, counted from the times of those that came."""
from collections import deque
from statistics import median, median_low
from typing import NamedTuple

WINDOW = 17      # steps around the one judged, as far as the board says nothing between them; their median is the row period there
GAP_FROM = 1.75  # periods: one lost row makes 2.0; rows read by the clock (fault 5) come up to half a period early and late: 1.5


class Step(NamedTuple):
    us: int
    dropped: bool  # the board says that it dropped rows before this one (flag 256)
    excused: bool  # no sample on one side
    spoken: bool   # the board said something in between: a stop, a fault, a change of rate


class Gaps:
    """add() each step between two rows; cut() where the rows before and after have nothing to do with each other."""

    def __init__(self):
        self.on_the_way = self.by_the_board = self.pauses = self.pauses_us = 0
        self.steps = deque(maxlen=WINDOW)
        self.judged = 0  # of those in the window

    @property
    def lost(self):
        """Rows; those of the last half window are not counted before cut()."""
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
    """The row period at this step: what the board says may change it, so the steps beyond do not count; of two the lesser."""
    if steps[place].spoken:
        return median(step.us for step in steps)
    begin = end = place
    while begin and not steps[begin - 1].spoken:
        begin -= 1
    while end < len(steps) and not steps[end].spoken:
        end += 1
    return median_low(step.us for step in steps[begin:end])
