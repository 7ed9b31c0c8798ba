"""Where the cycles of the dearest filter go: the firmware on the outlier stream, by the function that the simulator's profile names."""
import collections
import csv

from laws import SLOWEST
from results import Fault, markdown

FILTER = SLOWEST
STREAM = "outliers-15pct"
ENTRY = "mixed"  # called once per axis and sample
# what of the profile is the filter's, and what the page says of it
FUNCTIONS = {
    "mixed": "prediction, evidence, probability and learning (what is in line of it)",
    "log2_uq9": "logarithms, by a table",
    "believe": "",
    "filter_wide_correct": "gains, x and P",
    "give_back": "",
    "bend_lsb": "",
    "filter_fx_mul_uq16": "products",
    "filter_fx_mul24_uq24": "",
    "__umulhisi3": "",
    "__muluhisi3": "",
    "filter_fx_inverse_uq16": "reciprocals, by a table",
    "filter_fx_leading": "leading bits and shifts",
    "filter_fx_shift_right": "",
    "__prologue_saves__": "calls: registers saved and restored",
    "__epilogue_restores__": "",
}


def read_profile(path):
    """{function: cycles} and {function: calls}; what the linker's optimiser puts behind a name is left out."""
    cycles, calls = collections.Counter(), {}
    with open(path, encoding="ascii") as file:
        for row in csv.DictReader(file):
            name, _, offset = row["symbol"].partition("+")
            name = name.partition(".lto_priv")[0]
            cycles[name] += int(row["cycles"])
            if offset == "0x0":
                calls[name] = calls.get(name, 0) + int(row["count"])
    return cycles, calls


def parts(cycles, calls):
    """[(what, cycles per call of the filter)]: a function without words of its own counts to the one before it."""
    updates = calls.get(ENTRY, 0)
    missing = [function for function in FUNCTIONS if function not in cycles]
    if updates == 0 or missing:
        raise Fault(f"{', '.join(missing) or ENTRY} is not in the profile of {STREAM}: renamed, or now in line of its caller")
    result = []
    for function, words in FUNCTIONS.items():
        share = cycles[function] / updates
        if words:
            result.append([words, share])
        else:
            result[-1][1] += share
    return result


def page_lines(found):
    parts_and_sum = [*sorted(found, key=lambda part: -part[1]), ("together", sum(share for _, share in found))]
    rows = [[words, f"{share:,.0f}"] for words, share in parts_and_sum]
    return [f"| `{FILTER}`, {STREAM}, cycles per sample and axis, mean | |", *markdown(["", ""], rows)[1:]]
