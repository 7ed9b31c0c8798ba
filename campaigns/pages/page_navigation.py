"""make navcheck, after the flights of nav/tests/test_nav_image.py: nav/lib alone in the simulated chip, and docs/results/navigation.md.

    page_navigation.py FLIGHTS.json     what test_nav_image.py wrote; build/nav.json is these rows and those of nav/lib
"""
import concurrent.futures
import json
import pathlib
import re
import subprocess
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from results import Fault, Results, output_of, run_as_program, table

DOCUMENT = pathlib.Path("docs/results/navigation.md")
JSON = pathlib.Path("build/nav.json")
SECONDS = 500
STATES = (12, 9)
COLUMNS = ["", *(f"{states} states" for states in STATES)]

ABOUT = f"""\
{SECONDS} s of the flight of paper 003 (section 3.4) in the simulated ATmega328P at 16 MHz: IMU at 100 Hz, field at 10 Hz, GPS and altimeter at 1 Hz,
no GPS from 160 to 400 s. `make navcheck` fails when a state or variance differs from the PC's in any bit, a record is lost, or a limit is broken.
What the image is: [navigation](../navigation.md). Sigmas and errors beside the thesis: [paper 003](../papers-003.md)."""
PAGE = Results(DOCUMENT, "The navigation image", "make navcheck", ABOUT)

OF_IMAGE = "The image that `make nav` builds, serial line and interrupts included; each state is sent after ten IMU records, GPS 120 ms late."
OF_FLIGHT = "The largest error in each interval of that flight."
PICTURE = ["![Errors of attitude, velocity and position with their sigmas](pictures/navigation.png)", "",
           "Without the late GPS; `tilt nav --board pc --plot docs/results/pictures/navigation.png` draws it.", ""]
OF_SLOTS = """\
Without the image: `build/host/nav_chip_12 build/uno/nav_slots_12.elf 500`. Cycles of one `nav_imu` by its job, mean and most; of the other calls the
most."""
JOBS = {"slot with take in": "slot that takes in epochs", "slot with scalar": "slot that uses a scalar", "slot with noise": "slot that adds noise"}


def chip_rows(text, states):
    """What nav/tests/nav_chip.c prints."""
    rows = [{"part": "call", "states": states, "call": name, "calls": int(calls), "cycles_mean": int(mean), "cycles_max": int(most)}
            for name, calls, mean, most in re.findall(r"^(?:call )?([\w ]+): (\d+), mean (\d+), most (\d+) cycles$", text, re.M)]
    last = re.search(r"^load ([\d.]+) %; static (\d+), stack (\d+) bytes; (\d+) of (\d+) states differ from the PC$", text, re.M)
    if not last or len(rows) < 8:
        raise Fault(f"nav_chip_{states}: it did not run to its end")
    load, *whole = last.groups()
    numbers = dict(zip(("static_bytes", "stack_bytes", "differ", "compared"), map(int, whole)))
    return rows + [{"part": "alone", "states": states, "load_percent": float(load), **numbers}]


def flash_bytes(elf):
    return sum(int(size) for size in re.findall(r"^\.(?:text|data)\s+(\d+)", output_of(["avr-size", "-A", elf]), re.M))


def alone(states):
    """nav/lib without the image."""
    elf = f"build/uno/nav_slots_{states}.elf"
    done = subprocess.run([f"build/host/nav_chip_{states}", elf, str(SECONDS)], stdout=subprocess.PIPE, text=True, timeout=3600, check=False)
    if done.returncode:
        raise Fault(f"nav_chip_{states} gave status {done.returncode}")
    rows = chip_rows(done.stdout, states)
    rows[-1]["flash_bytes"] = flash_bytes(elf)
    return rows


def of(rows, part):
    """The rows of a part, of the number of states in the order of the page."""
    return [[row for row in rows if row["part"] == part and row["states"] == states] for states in STATES]


def image_table(rows):
    images = [found[0] for found in of(rows, "image")]
    lines = (("mean load", lambda r: f"{100 * r['cpu_load']:.3g} %"),
             ("longest pass of the main loop", lambda r: f"{r['pass_max_cycles'] / 16000:.2f} ms"),
             ("static RAM and stack", lambda r: f"{r['ram_used_bytes']:,} B"),
             ("flash", lambda r: f"{r['flash_bytes']:,} B"), ("records sent, none lost", lambda r: f"{r['records']:,}"),
             ("states compared, none differs", lambda r: f"{r['compared']:,}"))
    return table("The image", OF_IMAGE, COLUMNS, [[name, *map(cell, images)] for name, cell in lines])


def flight_table(rows):
    return table("Errors of the flight", OF_FLIGHT,
                 ["states", "interval, s", "GPS", "heading, degrees", "roll and pitch, degrees", "velocity, m/s", "position, m"],
                 [[str(r["states"]), f"{r['from_s']:.0f} to {r['to_s']:.0f}", "yes" if r["interval"] == "GPS" else "no", f"{r['heading_deg']:.2f}",
                   f"{r['level_deg']:.2f}", f"{r['velocity_mps']:.3f}", f"{r['position_m']:.2f}"] for found in of(rows, "flight") for r in found])


def slots_table(rows):
    calls = of(rows, "call")
    by_name = [{row["call"]: row for row in found} for found in calls]
    own = [found[0] for found in of(rows, "alone")]
    lines = [[words, *(f"{cell[name]['cycles_mean']:,}, {cell[name]['cycles_max']:,}" for cell in by_name)] for name, words in JOBS.items()]
    lines += [[f"`nav_{name}`", *(f"{cell[name]['cycles_max']:,}" for cell in by_name)] for name in ("gps", "down", "field")]
    lines += [["mean load", *(f"{r['load_percent']:.1f} %" for r in own)], ["flash of the program", *(f"{r['flash_bytes']:,} B" for r in own)],
              ["static RAM, stack", *(f"{r['static_bytes']:,} B, {r['stack_bytes']:,} B" for r in own)],
              ["states that differ from the PC", *(f"{r['differ']} of {r['compared']:,}" for r in own)]]
    return table("nav/lib alone", OF_SLOTS, COLUMNS, lines)


def lines(rows):
    """The page's text and tables."""
    return [*image_table(rows), *flight_table(rows), *PICTURE, *slots_table(rows)]


def main():
    if len(sys.argv) != 2:
        raise Fault("FLIGHTS.json")
    rows = json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="ascii"))
    if sorted(row["seconds"] for row in rows if row["part"] == "image") != [SECONDS, SECONDS]:
        raise Fault(f"{sys.argv[1]}: not both flights of {SECONDS} s")
    with concurrent.futures.ThreadPoolExecutor(len(STATES)) as workers:
        rows += [row for found in workers.map(alone, STATES) for row in found]
    JSON.write_text(json.dumps(rows, indent=1) + "\n", encoding="ascii")
    PAGE.write(lines(rows))
    print(f"navigation: {len(rows)} rows; {DOCUMENT} and {JSON} written")
    return 0


if __name__ == "__main__":
    run_as_program("navigation", main)
