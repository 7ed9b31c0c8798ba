#!/usr/bin/env python3
"""progress.py make ARGUMENT...: runs this make and reports progress: "building 37 of 104: TARGET".

The total is what `make -n` would do (0.2 s for this tree); steps are counted by --trace. On a terminal one line is updated; a log gets a line
every few seconds. The stderr of compilers and make passes unchanged; from stdout only the commands themselves are removed. The status is
make's.
"""
import os
import re
import selectors
import subprocess
import sys
import time

STEP = re.compile(r"^\S+:\d+: (?:update )?target '([^']+)'")  # the words after it differ between versions of make
ENGLISH = {**{name: value for name, value in os.environ.items() if name != "LANGUAGE"}, "LC_ALL": "C"}  # STEP matches make's English output
LOG_S, STILL_S, TERMINAL_S = 5.0, 30.0, 0.1


def planned(command):
    """(number of steps, the lines of their commands); (0, nothing) if make fails: it prints the reason when it runs."""
    done = subprocess.run([*command, "-n", "--trace"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, errors="replace",
                          env=ENGLISH, check=False)
    lines = done.stdout.splitlines()
    return sum(STEP.match(line) is not None for line in lines), set(lines)


class Progress:
    """The progress line."""

    def __init__(self, count, stream):
        self.count, self.stream, self.live = count, stream, stream.isatty()
        self.done, self.target, self.began, self.shown, self.shown_done = 0, "", time.monotonic(), 0.0, 0

    def step(self, target):
        self.done, self.target = self.done + 1, target
        self.count = max(self.count, self.done)
        self.show()

    def show(self):
        """At most every few seconds; less often if nothing is new."""
        now = time.monotonic()
        least_s = TERMINAL_S if self.live else LOG_S if self.done > self.shown_done else STILL_S
        if self.done and now - self.shown >= least_s:
            self.shown, self.shown_done = now, self.done
            self.write(f"building {self.done} of {self.count} ({now - self.began:.0f} s): {self.target}")

    def write(self, text):
        # the cursor returns to the beginning of the line, so that an error overwrites it
        self.stream.write(f"\r\x1b[K{text[:100]}\r" if self.live else f"{text}\n")
        self.stream.flush()

    def pass_on(self, line):
        self.stream.write(("\x1b[K" if self.live else "") + line + "\n")
        self.stream.flush()

    def end(self, status):
        if self.live:
            self.stream.write("\x1b[K")
        if self.done:
            word = "built" if status == 0 else "building stopped at"
            self.stream.write(f"{word} {self.done} of {self.count} after {time.monotonic() - self.began:.0f} s\n")
        self.stream.flush()


def lines_of(pipe):
    """Whole lines as they arrive; None every second without one."""
    rest = b""
    with selectors.DefaultSelector() as ready:
        ready.register(pipe, selectors.EVENT_READ)
        while True:
            if not ready.select(1.0):
                yield None
                continue
            data = os.read(pipe.fileno(), 1 << 16)
            *whole, rest = (rest + data).split(b"\n")
            yield from (line.decode("utf-8", "replace") for line in whole)
            if not data:
                break
    if rest:
        yield rest.decode("utf-8", "replace")


def main():
    command = sys.argv[1:]
    if not command:
        print("progress.py: usage: progress.py make ARGUMENT...", file=sys.stderr)
        return 2
    flags = os.environ.get("MAKEFLAGS", "").partition(" ")[0]
    if "n" in flags and not flags.startswith("-"):  # make -n: print what would be done, not the progress
        return subprocess.run(command, check=False).returncode
    count, commands = planned(command)
    progress = Progress(count, sys.stdout)
    with subprocess.Popen([*command, "--trace"], stdout=subprocess.PIPE, env=ENGLISH) as process:
        for line in lines_of(process.stdout):
            step = STEP.match(line) if line is not None else None
            if line is None:
                progress.show()
            elif step:
                progress.step(step.group(1))
            elif line not in commands:
                progress.pass_on(line)
    progress.end(process.returncode)
    return process.returncode


if __name__ == "__main__":
    sys.exit(main())
