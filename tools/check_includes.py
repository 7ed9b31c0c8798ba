#!/usr/bin/env python3
"""Who may include whom: the table of the design, enforced. Prints every breach as file:line and exits 1 on any."""
import pathlib
import re
import sys

STANDARD = {"stdint.h", "stdbool.h", "stddef.h"}
LIBC = STANDARD | {"stdio.h", "stdlib.h", "string.h", "math.h", "errno.h", "limits.h", "inttypes.h", "stdarg.h", "ctype.h", "float.h"}
HAL = {p.name for p in pathlib.Path("hal").glob("*.h")} | {"hal_port.h"}


def headers(*folders):
    return {p.name for folder in folders for p in pathlib.Path(folder).glob("*.h")}


FILTERS, TILT, ADXL = headers("lib/filters/src"), headers("lib/tilt/src"), headers("lib/adxl345/src")
FIRMWARE, SIM = headers("firmware"), headers("sim")
MODEL = {"adxl345_model.h", "stream.h"}
SIMAVR = re.compile(r"^(sim_|avr_|uart_pty|libelf|gelf|getopt|unistd|time|sys/|fcntl|pthread|signal|poll|termios|math)")

# folder -> (plain names allowed, pattern of further names allowed)
RULES = {
    "lib/filters/src": (STANDARD | FILTERS, None),
    "lib/tilt/src": (STANDARD | TILT | {"fx.h"}, None),
    "lib/adxl345/src": (STANDARD | ADXL | HAL, None),
    "hal": (STANDARD | {"hal_port.h"}, None),
    "hal/avr": (STANDARD | HAL, re.compile(r"^(avr|util)/")),
    "hal/host": (LIBC | HAL | MODEL | headers("hal/host"), None),
    "firmware": (STANDARD | FIRMWARE | FILTERS | TILT | ADXL | HAL, None),
    "sim": (LIBC | SIM | {"adxl345_registers.h"}, SIMAVR),
}
# the one file that may know the machine inside a pure library, and only under a guard
AVR_ALLOWED = {pathlib.Path("lib/filters/src/fx.h")}
PORT_LAST = [p for p in pathlib.Path("hal").glob("*.h") if p.name != "hal_ring.h"]


def breaches(folder, names, pattern):
    for path in sorted(pathlib.Path(folder).glob("*.[ch]")):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            found = re.match(r'\s*#\s*include\s+[<"]([^>"]+)[>"]', line)
            if not found:
                continue
            name = found.group(1)
            if name in names or (pattern and pattern.match(name)):
                continue
            if name.startswith("avr/") and path in AVR_ALLOWED:
                continue
            yield f"{path}:{number}: {folder} may not include {name}"


def contracts_end_with_port():
    for path in PORT_LAST:
        includes = re.findall(r'^\s*#\s*include\s+[<"]([^>"]+)[>"]', path.read_text(), re.M)
        if not includes or includes[-1] != "hal_port.h":
            yield f"{path}:1: the last include of a contract is hal_port.h"


def machine_guards():
    for folder in ("lib/filters/src", "lib/tilt/src", "lib/adxl345/src", "firmware"):
        for path in sorted(pathlib.Path(folder).glob("*.[ch]")):
            if path in AVR_ALLOWED:
                continue
            for number, line in enumerate(path.read_text().splitlines(), 1):
                if "__AVR" in line:
                    yield f"{path}:{number}: only {next(iter(AVR_ALLOWED))} may ask for __AVR__"


def main():
    found = [b for folder, (names, pattern) in RULES.items() for b in breaches(folder, names, pattern)]
    found += list(contracts_end_with_port()) + list(machine_guards())
    for line in found:
        print(line)
    print(f"include table: {len(found)} breaches")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
