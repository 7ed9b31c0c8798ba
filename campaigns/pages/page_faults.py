"""docs/results/faults-campaign.md: the rows of build/faults.json as tables."""
import pathlib

import faults_commands
from faults_judge import NO_LIMIT
from faults_kinds import OTHER_RATES
from laws import DEFAULT, LIGHT
from results import Results, table

DOCUMENT = pathlib.Path("docs/results/faults-campaign.md")

ABOUT = f"""\
Every fault of the simulator is put into the unmodified firmware at every byte on the bus during a sample, at the entry of every function that runs
for one, and at moments spread over its period, with `{DEFAULT}` and with `{LIGHT}`, whose lack of a gate hides no wrong reading; then every pair of
faults, long outages, other rates, and faults during a command. Each run is judged by what the virtual sensor latched, not by the firmware's own
counters.

A run fails when the first good row comes later than its limit, rows stop or step back in time, more samples are lost than the fault's time and its
limit hold, a row without a flag shows what the sensor did not latch, a pass of the main loop takes more than 4 ms, an interrupt with a deadline
waits longer than 248 cycles, or there is a reset too many or too few. `faults_judge.py` has every limit. Words, LED and angles are left to unit
tests.

`-`: no limit, or nobody can know it from rows. "Not detectable": a value that changes inside a well-formed transfer; as many rows may be wrong as
samples were altered. `make faults SAMPLE=300` is a sample and leaves this page as it is."""
PAGE = Results(DOCUMENT, "The fault campaign", "make faults", ABOUT)

OF_RATES = "Worst ms to a good row, samples lost."
OF_COMMANDS = "Phases, worst ms to a good row. A fault of one transfer strikes each transfer of the change; the others begin or end within it."
OF_FLAGS = "Of the changes of 8 sigma or more, 99 % must be flagged."
OF_ROLL = "One fault in 1,000 samples, beside the run without faults: 99.9 % of the rows must have roll within 0.5 degree."


def lost_words(row):
    """- where no run could know."""
    return "-" if row["worst_rows_lost"] is None else row["worst_rows_lost"]


def crossed(title, text, columns, bases, cell, named):
    """A line for each base, with a cell for each column (heading, key): what cell(row, key) says of the row that named(base, key) gives."""
    def filled(row, key):
        return cell(row, key) + (f", {row['failed']} FAILED" if row["failed"] else "") if row else "-"
    return table(title, text, ["fault", *(heading for heading, _ in columns)],
                 [[base, *(filled(named(base, key), key) for _, key in columns)] for base in dict.fromkeys(bases)])


def rates_table(rows):
    """A line for each kind, with what it came to at each of the other rates."""
    of = {row["fault"]: row for row in rows}
    return crossed("At other rates", OF_RATES, [(f"{rate:g} Hz", rate) for rate in OTHER_RATES], (fault.rpartition(",")[0] for fault in of),
                   lambda row, rate: f"{row['worst_ms_to_good']:.1f}, {lost_words(row)}", lambda base, rate: of.get(f"{base}, {rate:g} Hz"))


def commands_table(rows):
    """A line for each kind, with what it came to under each command: where it ends in standby, no good row comes."""
    of = {row["fault"]: row for row in rows}
    columns = [(f"`{command.name}`", command.name) for command in faults_commands.COMMANDS]
    return crossed("During a command", OF_COMMANDS, columns, (fault.rpartition(": ")[2] for fault in of),
                   lambda row, name: f"{row['phases']}, " + (f"{row['worst_ms_to_good']:.1f}" if name != "stop" else "-"),
                   lambda base, name: of.get(f"command {name}: {base}"))


def singles_table(rows):
    head = ["fault", "phases", "recovered", "worst ms to a good row", "limit", "worst rows lost", "wrong rows", "resets too many or too few",
            "longest pass (ms)", "failed"]
    return table("Each fault", "", head, [[row["fault"], str(row["phases"]), f"{row['recovered']} of {row['runs']}", f"{row['worst_ms_to_good']:.1f}",
                                           str(row["limit_ms"] if row["limit_ms"] < NO_LIMIT else "-"), str(lost_words(row)),
                                           f"{row['wrong_rows']}{'' if row['detectable'] else ' (not detectable)'}", str(row["wrong_resets"]),
                                           f"{row['longest_pass_cycles'] / 16000:.2f}", str(row["failed"])] for row in rows])


def pairs_lines(rows):
    failing = [f"{row['fault']} ({row['failed']} of {row['runs']})" for row in rows if row["failed"]]
    return ["## Pairs of faults", f"{len(rows)} pairs, {sum(row['runs'] for row in rows)} runs, {sum(row['failed'] for row in rows)} failed"
            f"{': ' + '; '.join(failing[:40]) if failing else ''}.", ""]


def shares_tables(extra):
    flagged, roll, lines = ([row for row in extra if key in row] for key in ("flagged", "rows", "lines"))
    return [*table("Values changed on their way", OF_FLAGS, ["fault", "changes of 8 sigma or more", "flagged", "share"],
                   [[r["fault"], str(r["changes_of_8_sigma"]), str(r["flagged"]), f"{100 * r['flagged'] / max(1, r['changes_of_8_sigma']):.2f} %"]
                    for r in flagged]),
            *table("Roll under frequent faults", OF_ROLL, ["fault", "rows", "rows without a partner", "within 0.5 degree", "worst (degree)"],
                   [[r["fault"], str(r["rows"]), str(r["rows_without_partner"]), f"{100 * r['share_within_half_degree']:.3f} %",
                     f"{r['worst_cdeg'] / 100:.2f}"] for r in roll]),
            *(f"## Coverage\nThese runs execute {r['lines_executed']} of {r['lines']} lines of the AVR binary, "
              f"{100 * r['lines_executed'] / r['lines']:.1f} %." for r in lines)]


def tables(rows, extra):
    """The page's tables, as lines."""
    def of(*groups):
        return [row for row in rows if row["group"] in groups]
    return [*singles_table(of("single", "long", "typed")), *rates_table(of("rate")), *commands_table(of("command")), *pairs_lines(of("pair")),
            *shares_tables(extra)]


def write(rows, extra, sources):
    PAGE.write(tables(rows, extra), sources)
