#!/usr/bin/env python3
"""chip_test.py IMAGE.elf: runs a test image in the simulator and passes on what its UART says, a Unity report.

The image ends by sleeping with interrupts off (status 8 of simrun). The report of filter_sequence_1.elf must equal the one
of build/host/filter_sequence_1 line by line: answers, flags and probes of the first 10^5 updates.
"""
import pathlib
import re
import subprocess
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import OUT, SIMRUN, STREAMS

STOPPED = 8
LIMIT_MS = 200000  # of simulated time


def report_of(image):
    OUT.mkdir(parents=True, exist_ok=True)
    out = OUT / f"chip-{image.stem}.txt"
    out.unlink(missing_ok=True)
    if not pathlib.Path(SIMRUN).is_file():
        return "", f"{SIMRUN} is not there (make test builds it)"
    done = subprocess.run([SIMRUN, "--fw", image, "--in", STREAMS / "tilt-fast.csv", "--out", out, "--max-ms", str(LIMIT_MS)],
                          capture_output=True, text=True, timeout=600)
    report = out.read_text(encoding="ascii", errors="replace") if out.exists() else ""
    if done.returncode != STOPPED:
        last = done.stderr.strip().splitlines()[-1:] or ["no message"]
        return report, f"{image.name} did not run to its end: {last[0]}"
    return report, None


def first_difference(chip, host):
    """None, or a sentence about the first line that differs."""
    for number, (a, b) in enumerate(zip(chip, host), 1):
        if a != b:
            return f"line {number}: chip '{a}', PC '{b}' (updates, CRC-32, configurations, drawn in vain)"
    return None if len(chip) == len(host) else f"chip {len(chip)} lines, PC {len(host)}"


def judged_sequence(image, report):
    host = subprocess.run([f"build/host/{image.stem}", "100000", "10000"], capture_output=True, text=True, timeout=600, check=True)
    chip = report.splitlines()
    problem = first_difference(chip, host.stdout.splitlines())
    lines = [line for line in chip if not re.match(r"\d+ Tests ", line)]
    lines.append("chip_test.py:sequence_equals_that_of_the_pc:" + ("PASS" if problem is None else f"FAIL: {problem}"))
    failures = sum(":FAIL" in line for line in lines)
    return "\n".join(lines) + f"\n2 Tests {failures} Failures 0 Ignored\n", failures


def main():
    if len(sys.argv) != 2 or not pathlib.Path(sys.argv[1]).is_file():
        print("chip_test.py: usage: chip_test.py IMAGE.elf (make builds them: build/uno/tests)", file=sys.stderr)
        return 2
    image = pathlib.Path(sys.argv[1])
    report, problem = report_of(image)
    if problem is not None:
        print(report)
        print(f"chip_test.py:{image.stem}:FAIL: {problem}\n1 Tests 1 Failures 0 Ignored")
        return 1
    found = re.search(r"^(\d+) Tests (\d+) Failures (\d+) Ignored", report, re.M)
    if found is None or found.group(1) == "0":
        print(f"{report}\nchip_test.py:{image.stem}:FAIL: the image sent no report\n1 Tests 1 Failures 0 Ignored")
        return 1
    failures = int(found.group(2))
    if image.stem.startswith("filter_sequence"):
        report, failures = judged_sequence(image, report)
    print(report)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
