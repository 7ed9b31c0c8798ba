"""Rows that are missing, counted from the times of those that came."""
from collections import deque
from statistics import median
from typing import NamedTuple

WINDOW = 17      # steps around the one judged; their median is the row period there, so `rate` and `every` may change at any time
GAP_FROM = 1.75  # periods: one lost row makes 2.0; rows read by the clock (fault 5) come up to half a period early and late: 1.5


class Step(NamedTuple):
    us: int
    dropped: bool  # the board says that it dropped rows before this one (flag 256)
    excused: bool  # no sample on one side, or the board said something in between: a stop, a fault, a change of rate


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

    def add(self, us, dropped=False, excused=False):
        if len(self.steps) == WINDOW:
            self.judged -= 1
        self.steps.append(Step(us, dropped, excused))
        if len(self.steps) == WINDOW:
            self.judge_to(WINDOW // 2 + 1)

    def cut(self):
        self.judge_to(len(self.steps))
        self.steps.clear()
        self.judged = 0

    def judge_to(self, end):
        period_us = max(1, median(step.us for step in self.steps)) if self.steps else 1
        for step in list(self.steps)[self.judged:end]:
            self.judge(step, period_us)
        self.judged = end

    def judge(self, step, period_us):
        missing = round(step.us / period_us) - 1 if step.us >= GAP_FROM * period_us else 0
        if step.dropped:
            self.by_the_board += max(1, missing)
        elif missing and step.excused:
            self.pauses, self.pauses_us = self.pauses + 1, self.pauses_us + step.us
        else:
            self.on_the_way += missing
