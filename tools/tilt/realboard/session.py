"""The owner is led through the table, and each verdict is written before the next check begins."""
import time

from tilt.errors import TiltError
from tilt.realboard import judges_starts, watch
from tilt.realboard.bench import Failed, Quit, Repeat, Skip
from tilt.realboard.checks import CHECKS
from tilt.realboard.record import check_line, numbers_in_words

MEET_S, MEET_STRANGE_S = 8.0, 16.0  # a silent port; one at which bytes come: the board is looked for at each baud rate
VERSION_AFTER_S = 3.0               # where no banner has come: the board was not reset by the opening, or is stopped
OPENED_S, BEGUN_S = 1.0, 1.0
READY_S = 15.0
LONGEST_SHOWN = 80


def meet(bench, name):
    """(first line of the banner, name -> value of its settings). TiltError by anything but a board of this firmware."""
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
        if seen.kind != "back" or seen.at_s > began_s + OPENED_S:  # another baud rate is tried
            until_s = began_s + MEET_STRANGE_S
            strange += [seen] if seen.kind in ("strange", "back") else []
    raise TiltError(f"{name}: {what_came(strange)}")


def what_came(strange):
    text = [seen.text for seen in strange if seen.kind == "strange" and seen.text.isascii() and seen.text.isprintable()]
    if text:
        return f"text comes, but not this firmware's: '{max(text, key=len)[:LONGEST_SHOWN].strip()}'. Is it the right port? `make flash` writes it"
    if strange:
        return "bytes come, but no text at any baud rate of this firmware. Is it the right port? `make flash` writes it"
    return f"nothing came in {MEET_S:.0f} s. Is it the right port, has the board this firmware? `make flash` writes it"


def settle(bench, name):
    """The settings with which the board has begun."""
    try:
        watch.row_with_sample(bench, BEGUN_S)
    except Failed:
        pass  # a fault, or plotter mode
    try:
        bench.forget()
        told = {each: value for each, (value, _) in watch.listed(bench).items()}
        fault = watch.counters(bench).get("fault", 0)
    except Failed as why:
        raise TiltError(f"{name}: the board has said who it is, but does not answer: {why}") from why
    if fault:
        bench.say(f"The board reports fault {fault}: put that right first (docs/faults.md says what to check), then press Enter or r.")
    return told


class Session:
    """run() is True when every check that was chosen has passed or was skipped."""

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
        """Again, as often as the owner wants."""
        attempt = 1 + sum(line["kind"] == "check" and line["number"] == number for line in self.record.read)
        while True:
            again = False
            try:
                verdict = self.once(number, check, attempt)
                again = self.after(number, check, verdict)
            except Repeat:
                self.bench.say("   once more")
                again = True
            if not again:
                return
            attempt += 1

    def once(self, number, check, attempt):
        """One try, and its line of the record; Repeat and Quit leave none."""
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
        told = "; ".join(part for part in (reason, numbers_in_words(bench.numbers)) if part)
        bench.say(f"   {verdict}{': ' if told else ''}{told}")
        if verdict == "fail":
            bench.say(f"   What it means: {check.failing}.")
        return verdict

    def lead_in(self, number, check):
        """Whatever the owner does from the prompt on is seen, also before Enter is pressed."""
        bench = self.bench
        bench.say(f"\n{number:2}/{len(CHECKS)} {check.key} (waits {check.limit_s} s)")
        bench.forget()
        watch.row_with_sample(bench, READY_S)
        judges_starts.ready(bench)
        watch.row_with_sample(bench, READY_S)
        bench.say(f"   {check.do}")
        if not check.alone:
            bench.heed(bench.line("   Enter begins; s REASON skips, r repeats, q ends, here and at any moment: "))

    def after(self, number, check, verdict):
        """True: once more. A note goes into the record."""
        if verdict == "pass" and check.alone:
            return False
        while True:
            typed = self.bench.line("   Enter goes on; r repeats, q ends, anything else is a note for the record: ").strip()
            if typed == "r":
                return True
            if typed == "q":
                raise Quit
            if not typed:
                return False
            self.record.add({"kind": "note", "number": number, "text": typed})
