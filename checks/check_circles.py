#!/usr/bin/env python3
"""No circles: of two modules at most one may use what the other defines, also by way of others; and no header of firmware, hal, lib and nav/lib
declares an object. Looks into the compiled objects: an arrow is a symbol used here and defined there. The rooms of the firmware are one folder.

    check_circles.py OBJECTS...     folders of objects of the chip and of the PC, with the sources' paths in them
"""
import graphlib
import pathlib
import re
import sys

from check_includes import code
from check_support import Stop, main, report, run

# what is looked at, each for itself
FOLDERS = ["firmware", "lib/filters/src", "lib/tilt/src", "lib/adxl345/src", "hal/host", "sim"]
HEADERS = ["firmware", "hal", "lib", "nav/lib"]
ALLOWED = {"hal/avr/hal_time_port.h": "extern volatile hal_tick_t hal_tick;"}  # inline in interrupts, where a call costs 16 cycles of registers
OBJECT = re.compile(r'^\s*extern\s+(?!"C")[^(;]*;', re.M)


def modules(objects, folder):
    """{source without its suffix: (symbols defined, symbols used)} of a folder with those below it."""
    found = {}
    for root in map(pathlib.Path, objects):
        for path in sorted((root / folder).rglob("*.o")):
            source = path.relative_to(root).with_suffix("")
            lines = [line.split() for line in run("avr-nm" if "avr" in root.parts else "nm", "-P", path).splitlines()]
            found[str(source)] = ({name for name, kind, *_ in lines if kind in "TDBRCVW"}, {name for name, kind, *_ in lines if kind == "U"})
    return found


def arrows(found):
    """{module: {module used: one of the symbols}}"""
    home = {name: source for source, (defined, _) in found.items() for name in defined}
    return {source: {home[name]: name for name in sorted(used) if home.get(name, source) != source} for source, (_, used) in found.items()}


def circle(graph):
    """The modules along one circle, the first again at the end; none: []."""
    try:
        graphlib.TopologicalSorter({source: list(used) for source, used in graph.items()}).prepare()
    except graphlib.CycleError as error:
        return error.args[1][::-1]
    return []


def circles(objects):
    for folder in FOLDERS:
        found = modules(objects, folder)
        sources = {str(path.with_suffix("")) for path in pathlib.Path(folder).rglob("*.c")}
        if sources - set(found):
            raise Stop(f"{folder}: no object of {min(sources - set(found))}: build them first (make check-objects)")
        graph = arrows({source: symbols for source, symbols in found.items() if source in sources})
        steps = circle(graph)
        if steps:
            ways = "; ".join(f"{a} uses {graph[a][b]} of {b}" for a, b in zip(steps, steps[1:]))
            yield f"{steps[0]}.c: a circle: {ways}"


def objects_in_headers():
    allowed = set(ALLOWED.items())
    for folder in HEADERS:
        for path in sorted(pathlib.Path(folder).rglob("*.h")):
            for found in OBJECT.finditer("\n".join(line for _, line in code(path))):
                words = " ".join(found.group().split())
                if re.search(r"\bconst\b", words) or (str(path), words) in allowed:
                    allowed.discard((str(path), words))
                else:
                    yield f"{path}: declares an object, which anybody may change: {words}"
    for path, words in sorted(allowed):
        yield f"{path}: has no object '{words}', which ALLOWED of check_circles.py allows"


def findings():
    if not sys.argv[1:]:
        raise Stop("which folders of objects? (make check-circles)")
    yield from circles(sys.argv[1:])
    yield from objects_in_headers()


if __name__ == "__main__":
    main(lambda: report("circles", list(findings()), f"none in {', '.join(FOLDERS)}; no object in a header of {', '.join(HEADERS)}"))
