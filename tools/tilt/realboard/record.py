"""The record of a session: lines of JSON, each written whole and flushed at once, so that an early end leaves a readable file. Nothing is
ever removed: a repeated check has several lines, of which the last counts; --resume adds lines."""
import datetime
import importlib.metadata
import json
import os
import pathlib
import platform

from tilt.errors import TiltError, at

FORM = 1  # version of the line format
SENT_IN = "open an issue 'tilt board' in the project and attach the file"


def now():
    return datetime.datetime.now().astimezone().isoformat(timespec="seconds")


def tool_version():
    try:
        return importlib.metadata.version("tilt-uno-tools")
    except importlib.metadata.PackageNotFoundError:
        return "not installed"


def begin_line(port, usb, firmware, settings):
    """The board and the program. The serial number of the USB port is left out: it is private."""
    return {"kind": "begin", "form": FORM, "at": now(), "tool": tool_version(), "os": platform.platform(), "python": platform.python_version(),
            "port": port, "usb": usb, "firmware": firmware, "settings": settings}


def check_line(number, check, verdict, reason, attempt, took_s, bench):
    return {"kind": "check", "number": number, "key": check.key, "verdict": verdict, "reason": reason, "try": attempt, "at": now(),
            "took_s": round(took_s, 1), "numbers": bench.numbers, "lines": bench.lines}


class Record:
    """read: its lines so far; add() writes one. TiltError with the file's name on any failure."""

    def __init__(self, path, resumed=False):
        self.path, self.file = pathlib.Path(path), None
        self.read, self.spoilt = read_lines(self.path) if resumed else ([], [])
        self.resumed = resumed
        if not resumed and self.path.exists():
            raise TiltError(f"{path}: exists already: give --resume {path} to continue it, or another name with -o")
        if not self.path.parent.is_dir():
            raise TiltError(f"{path}: no folder {self.path.parent}")

    def add(self, line):
        try:
            if self.file is None:
                self.open()
            self.put(json.dumps(line).encode("ascii") + b"\n")
        except OSError as why:
            raise TiltError(f"{self.path}: {why.strerror}; the file holds what came before") from why
        self.read.append(line)

    def open(self):
        """Creates the file with its first line, so that a port that is not a board leaves none. Ends a line that was cut short."""
        if not self.resumed:
            self.file = open(self.path, "xb", buffering=0)  # pylint: disable=consider-using-with
            return
        self.file = open(self.path, "r+b", buffering=0)  # pylint: disable=consider-using-with
        size = self.file.seek(0, os.SEEK_END)
        self.file.seek(max(0, size - 1))
        if size and self.file.read(1) != b"\n":
            self.put(b"\n")

    def put(self, data):
        """Writes all of it, or nothing."""
        size, rest = self.file.tell(), memoryview(data)
        try:
            while rest:
                rest = rest[self.file.write(rest):]
            os.fsync(self.file.fileno())
        except OSError:
            self.file.truncate(size)
            raise

    def close(self):
        if self.file is not None:
            self.file.close()

    def last(self):
        """number -> the line that counts."""
        return {line["number"]: line for line in self.read if line["kind"] == "check"}

    def notes(self):
        """number -> the owner's notes."""
        found = {}
        for line in self.read:
            if line["kind"] == "note":
                found.setdefault(line["number"], []).append(line["text"])
        return found


def read_lines(path):
    """(lines, numbers of the unreadable ones). A cut line does not lose the rest; a file of another kind is rejected."""
    try:
        texts = pathlib.Path(path).read_text(encoding="utf-8", errors="replace").split("\n")
    except OSError as why:
        raise TiltError(f"{path}: {why.strerror}") from why
    lines, spoilt = [], []
    for number, text in enumerate(texts, 1):
        line = line_of(text)
        if line is not None:
            lines.append(line)
        elif text:
            spoilt.append(number)
        if number == 1 and (line is None or line["kind"] != "begin"):
            raise at(path, 1, "not a record of `tilt board`, which begins with {\"kind\": \"begin\"")
    if lines[0]["form"] != FORM:
        raise at(path, 1, f"record of form {lines[0]['form']}, but this program reads form {FORM}: use the program that wrote it")
    return lines, spoilt


NEEDED = {"begin": {"form": int, "at": str, "tool": str, "os": str, "port": str, "firmware": str},
          "check": {"number": int, "key": str, "verdict": str, "reason": str, "numbers": dict, "lines": list},
          "note": {"number": int, "text": str}, "end": {}}


def line_of(text):
    """The line as an object; None if it is cut or not ours."""
    try:
        line = json.loads(text)
    except ValueError:
        return None
    needed = NEEDED.get(line.get("kind")) if isinstance(line, dict) else None
    if needed is None or not all(isinstance(line.get(name), kind) for name, kind in needed.items()):
        return None
    return line


# --- shown ------------------------------------------------------------------------------------------------------------

def shown(record, checks):
    """The record as lines of text, one for each of the checks (number, check)."""
    begin, last, notes = record.read[0], record.last(), record.notes()
    out = [f"{record.path}: {begin['firmware']}", f"{begin['at']}, {begin['port']}, {begin['os']}, tilt {begin['tool']}", ""]
    width = max(len(check.key) for _, check in checks)
    for number, check in checks:
        line = last.get(number, {"verdict": "not done", "reason": "", "numbers": {}})
        details = "; ".join(part for part in (line["reason"], numbers_in_words(line["numbers"])) if part)
        out.append(f"{number:2} {check.key:{width}}  {line['verdict']:8}  {details}".rstrip())
        out += [f"{'':{width + 5}}note: {text}" for text in notes.get(number, [])]
    out += ["", tally(last, checks)]
    out += [f"{record.path}:{number}: unreadable (cut short?), skipped" for number in record.spoilt]
    return out


def numbers_in_words(numbers):
    return ", ".join(f"{name} {value}" for name, value in numbers.items() if value is not None)


def tally(last, checks):
    verdicts = [last[number]["verdict"] if number in last else "not done" for number, _ in checks]
    words = {"pass": "passed", "fail": "failed", "skipped": "skipped", "not done": "not done"}
    return ", ".join(f"{verdicts.count(verdict)} {word}" for verdict, word in words.items())
