"""What the descriptors of the filter library's laws declare."""
import pathlib
import re

DESCRIPTOR = re.compile(r'^const filter_law_t .*?\.name = "(\w+)".*?\.worst_cycles = (\d+)', re.M | re.S)


def worst_cycles():
    """{name: worst case of an update in cycles}, which make bench holds each to."""
    files = sorted(pathlib.Path("lib/filters/src").glob("*.c"))
    return {name: int(cycles) for file in files for name, cycles in DESCRIPTOR.findall(file.read_text(encoding="utf-8"))}
