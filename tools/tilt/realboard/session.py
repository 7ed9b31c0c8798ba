"""Leads the owner through the table; each verdict is written before the next check begins."""
import time

from tilt.errors import TiltError
from tilt.realboard import judges_starts, watch
from tilt.realboard.bench import Failed, Quit, Repeat, Skip
from tilt.realboard.checks import CHECKS
from tilt.realboard.record import check_line, numbers_in_words

MEET_S, MEET_STRANGE_S = 8.0, 16.0  # for a silent port; for one with input, as the board is searched for at each baud rate
VERSION_AFTER_S = 3.0               # without a banner: opening did not reset the board, or it is stopped
OPENED_S, BEGUN_S = 1.0, 1.0
READY_S = 15.0
LONGEST_SHOWN = 80


def meet(bench, name):
    """(first line of the banner, name -> value of its settings). TiltError unless it is a board with this firmware. What the owner types waits:
    there is nothing to skip or to repeat yet."""
    bench.deaf = True
    try:
        return met(bench, name)
    except Failed as why:
        raise TiltError(f"{name}: the port is gone: check the cable and its plugs") from why
    finally:
        bench.deaf = False


def met(bench, name):
    """See meet; Failed if nothing can be typed."""
    began_s, strange = bench.now(), []
    ask_s, until_s = began_s + VERSION_AFTER_S, began_s + MEET_S
    while bench.now() < until_s:
        seen = bench.next(min(ask_s, until_s))
        if bench.now() >= ask_s:
            bench.type("version")
            ask_s = until_s + MEET_STRANGE_S  # once
        if seen is None:
            continue
        if watch.is_banner(seen):
            return seen.text, settle(bench, name)
        if seen.kind != "back" or seen.at_s > began_s + OPENED_S:  # another baud rate is being tried
            until_s = began_s + MEET_STRANGE_S
            strange += [seen] if seen.kind in ("strange", "back") else []
    raise TiltError(f"{name}: {what_came(strange)}")


def what_came(strange):
    text = [seen.text for seen in strange if seen.kind == "strange" and seen.text.isascii() and seen.text.isprintable()]
    if text:
        return f"text, but not from this firmware: '{max(text, key=len)[:LONGEST_SHOWN].strip()}'. Check the port; `tilt flash` writes it"
    if strange:
        return "received bytes, but no text at any baud rate of this firmware. Check the port; `tilt flash` writes the firmware"
    return f"nothing received in {MEET_S:.0f} s. Check the port, and whether the board has this firmware: `tilt flash` writes it"


def settle(bench, name):
    """The settings that the board had at the start."""
    try:
        watch.row_with_sample(bench, BEGUN_S)
    except Failed:
        pass  # a fault, or plotter mode
    try:
        bench.forget()
        found = {each: value for each, (value, _) in watch.listed(bench).items()}
        fault = watch.counters(bench).get("fault", 0)
    except Failed as why:
        raise TiltError(f"{name}: the board sent its banner, but does not answer: {why}") from why
    if fault:
        bench.say(f"The board reports fault {fault}: repair it first (docs/faults.md lists what to check), then press Enter or r.")
    return found


class Session:
    """run() is True if every chosen check passed or was skipped."""

    def __init__(self, bench, record, checks):
        self.bench, self.record, self.checks = bench, record, checks

    def run(self):
        last = self.record.last()
        for number, check in self.checks:
            if last.get(number, {}).get("verdict") != "pass":
                self.until_done(number, check)
        self.record.add({"kind": "end"})
        return all(self.record.last()[number]["verdict"] != "fail" for number, _ in self.checks)

    def until_done(self, number, check):
        """Repeats the check as often as the owner wants."""
        attempt = 1 + sum(line["kind"] == "check" and line["number"] == number for line in self.record.read)
        while True:
            again = False
            try:
                verdict = self.once(number, check, attempt)
                again = self.after(number, check, verdict)
            except Repeat:
                self.bench.say("   again")
                again = True
            if not again:
                return
            attempt += 1

    def once(self, number, check, attempt):
        """One attempt, and its line in the record; Repeat and Quit leave none."""
        bench, began_s = self.bench, time.monotonic()
        bench.begin(check.limit_s)
        verdict, reason = "pass", ""
        try:
            self.lead_in(number, check)
            began_s = time.monotonic()
            check.judge(bench)
        except Failed as why:
            verdict, reason = "fail", str(why)
        except Skip as why:
            verdict, reason = "skipped", str(why)
        self.record.add(check_line(number, check, verdict, reason, attempt, time.monotonic() - began_s, bench))
        details = "; ".join(part for part in (reason, numbers_in_words(bench.numbers)) if part)
        bench.say(f"   {verdict}{': ' if details else ''}{details}")
        if verdict == "fail":
            bench.say(f"   What it means: {check.failing}.")
        return verdict

    def lead_in(self, number, check):
        """What the owner does after the prompt is seen, even before Enter is pressed."""
        bench = self.bench
        bench.say(f"\n{number:2}/{len(CHECKS)} {check.key} (limit {check.limit_s} s)")
        bench.forget()
        watch.row_with_sample(bench, READY_S)
        judges_starts.ready(bench)
        watch.row_with_sample(bench, READY_S)
        bench.say(f"   {check.do}")
        if not check.alone:
            bench.heed(bench.line("   Enter starts; at any time s REASON skips, r repeats, q quits: "))

    def after(self, number, check, verdict):
        """True: repeat the check. Writes a note to the record."""
        if verdict == "pass" and check.alone:
            return False
        while True:
            typed = self.bench.line("   Enter continues; r repeats, q quits, any other text is a note for the record: ").strip()
            if typed == "r":
                return True
            if typed == "q":
                raise Quit
            if not typed:
                return False
            self.record.add({"kind": "note", "number": number, "text": typed})
