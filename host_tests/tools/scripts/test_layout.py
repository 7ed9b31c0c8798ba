"""The order of the functions in the flash: far calls are counted as the chip has them, fewer are found, and the script loses no section."""
import pathlib
import re
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import image_with, run, run_all, test

import layout  # noqa: E402
from laws import DEFAULT  # noqa: E402

LOADED = {".text", ".data", ".bss", ".noinit", ".eeprom"}  # what uno.ld places, and what simrun and avrdude take


@test
def a_call_beyond_the_reach_is_far():
    sizes, edges = [10, 4090, 10], [(0, 0, 2, 0)]  # from the first function to the third
    assert layout.long_calls([0, 1, 2], sizes, edges) == 1 and layout.long_calls([0, 2, 1], sizes, edges) == 0
    sizes[1] = layout.REACH + 2 - 10  # the last place that a short call reaches
    assert layout.long_calls([0, 1, 2], sizes, edges) == 0


@test
def an_order_with_fewer_far_calls_is_found():
    sizes, edges = [1000] * 20, [(i, 0, 19 - i, 0) for i in range(10)]  # neighbours would do for all
    layout.MOVES = 3000
    order, far = layout.anneal(list(range(20)), sizes, edges)
    assert sorted(order) == list(range(20)) and far == layout.long_calls(order, sizes, edges)
    assert far <= 2 < layout.long_calls(range(20), sizes, edges)


@test
def what_the_compiler_numbers_is_one_function():
    assert layout.unit_of(".text.step.lto_priv.35") == layout.unit_of(".text.step") == ".text.step"
    assert layout.unit_of(".text.filter_axes") == ".text.filter_axes"


@test
def each_function_of_the_list_stands_there_once():
    lines = pathlib.Path("hal/avr/functions.ld").read_text(encoding="ascii").splitlines()[1:]
    names = [re.fullmatch(r"\*\((\.text\.\S+) \1\.\*\)", line)[1] for line in lines]
    assert len(names) == len(set(names)) > 100


@test
def nothing_of_the_image_lies_beside_the_sections_of_the_script():
    lines = run("avr-objdump", "-h", image_with(DEFAULT)).stdout.splitlines()
    loaded = {head.split()[1] for head, flags in zip(lines, lines[1:]) if "ALLOC" in flags}
    assert ".text" in loaded and loaded <= LOADED, loaded


if __name__ == "__main__":
    raise SystemExit(run_all())
