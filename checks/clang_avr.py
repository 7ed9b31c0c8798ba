"""Clang's view of the chip's code: the files and the options with which it parses them, its int having 16 bits."""
import pathlib
import shutil

from check_support import Stop, files

TARGET = ["--target=avr", "-mmcu=atmega328p", "-DF_CPU=16000000UL", "-isystem", "/usr/lib/avr/include"]
PORTABLE = ["-Ihal", "-Ifirmware", "-Inav/image", "-Ilib/machine/src", "-Ilib/filters/src", "-Ilib/tilt/src", "-Ilib/adxl345/src", "-Inav/lib"]
# Clang 14 cannot parse the assembler of avr/wdt.h, a naked function in C, or the built-in delay of avr-gcc: stand-ins for these
# (docs/deviations.md). What they replace is compiled by avr-gcc and runs in the simulator.
STAND_INS = ["-O2", "-D_AVR_WDT_H_", "-Dwdt_enable(x)=((void)(x))", "-Dwdt_disable()=((void)0)", "-Dwdt_reset()=((void)0)",
             *(f"-DWDTO_{ms}={n}" for n, ms in enumerate(("15MS", "30MS", "60MS", "120MS", "250MS", "500MS", "1S", "2S"))),
             "-Dnaked=", "-D__builtin_avr_delay_cycles=stand_in_for_a_delay"]
GROUPS = {
    "portable": (["lib", "firmware", "nav/lib", "nav/image"], ["-std=c11", *PORTABLE, "-Ihal/host"]),
    "chip": (["hal/avr"], ["-std=gnu11", *PORTABLE, "-Ihal/avr", *STAND_INS]),
}


def groups():
    """(name, files, options) of each way to parse."""
    for name, (folders, options) in GROUPS.items():
        yield name, files(".c", folders=folders), TARGET + options


def tool(name):
    """The tool that belongs to the installed clang-tidy, whose package brings it."""
    tidy = shutil.which("clang-tidy")
    if not tidy:
        raise Stop("clang-tidy is not installed: sh tools/deps.sh check")
    beside = pathlib.Path(tidy).resolve().parent / name
    found = str(beside) if beside.exists() else shutil.which(name)
    if not found:
        raise Stop(f"{name} is not installed beside {tidy}: sh tools/deps.sh check")
    return found


def relative(text):
    """Clang names files by their whole path."""
    return text.replace(f"{pathlib.Path.cwd()}/", "")
