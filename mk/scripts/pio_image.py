"""For platformio.ini: filters and options of the image that make builds by default, so that it fits the flash. The board's F_CPU is a signed
number, which costs 58 bytes; the linker gets -ffunction-sections because link-time optimisation makes the sections that hal/avr/uno.ld orders."""
import pathlib
import re
import sys

sys.path.append("mk/scripts")
import images  # noqa: E402

Import("env")  # noqa: F821
OWN = images.HOLDS["everyday"]
ELSEWHERE = [name for chosen in images.SETS for name in images.HOLDS[chosen] if name not in OWN]
for macro, names in (("FILTER_LIST", OWN), ("FILTERS_ELSEWHERE", ELSEWHERE)):
    env.Append(CPPDEFINES=[(f"{macro}(X)", "".join(f" X({name})" for name in names))])  # noqa: F821
SMALL = re.search(r"^AVR_SMALL +:= ((?:.*\\\n)*.*)", pathlib.Path("Makefile").read_text(encoding="utf-8"), re.M)[1].replace("\\\n", " ").split()
env.Append(CCFLAGS=SMALL, LINKFLAGS=[*SMALL, "-ffunction-sections"])  # noqa: F821
env.Replace(BOARD_F_CPU="16000000UL")  # noqa: F821
