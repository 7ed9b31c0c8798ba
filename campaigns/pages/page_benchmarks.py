"""docs/results/benchmarks.md: the tables of make bench as a page."""
import page_sources
from laws import LIGHT
from results import FOLDER, Results, section

DOCUMENT = FOLDER / "benchmarks.md"
CALLS, PARTS, PEERS = ("Filters, angles and rows", "Cycles of a sample, by part", "Beside other people's filters")

ABOUT = """\
Measured in simavr on an ATmega328P at 16 MHz: 16,000 cycles are 1 ms. Flash, RAM and stack are bytes. `make bench` fails when a limit is broken or
a number is more than 2 % above the committed page; to accept a new number, commit the page. With another compiler than avr-gcc 5.4.0 it only
reports."""

PAGE = Results(DOCUMENT, "Benchmarks: cycles, flash, RAM and stack", "make bench", ABOUT)

OF_CALLS = f"""\
Cycles per call, call and return included, interrupts off: one axis for a filter, roll and pitch together for `angles`. `min` and `worst` are over
all streams, `median` over the typical one; the streams are described in `bench_streams.h`. Everything is built with plain `-Os`, except the column
"firmware's flags" (`AVR_SMALL` in the Makefile). Flash and RAM are what an empty image grows by; "of it shared" is what the other filters link too.

- `start`: the samples of a filter's start, all filters together. `set_noise`: a new R. `noise`: the noise estimate of one sample.
- `sample_total`: the firmware from the sample to the row in the transmit ring, three axes with the default filter, interrupts excluded.
- `sample_rest` and `row`: the firmware without its filters, interrupts included, per sample and per row. `format_row`: the widest row.
- `float_NAME`: the same filter in `float`, which must give the same result within the bound beside it; `float_{LIGHT}_kept` keeps its coefficients.

Limits: the line `bench: worst` of each `float_NAME.c`; `angles` 1,500 cycles and 4 times."""

OF_PARTS = """\
The image that `make flash` writes, on `outliers-15pct` in a loop, mean of 6 s; 115200 baud at 100 Hz, 500000 above. `make cycles` measures this table
alone; the limits are in `cycles_by_part.txt`. Code that no part names is in `rest`."""

OF_PEERS = """\
The x axis of `sim/streams/outliers-15pct.csv` (slow tilt at 100 Hz, 4 LSB of noise, 15 % outliers of 20 times that) through each filter, without the
first hundred samples; the same flags for all. The stream is slow, which favours filters that lag: a position without a rate, a median. None of theirs
has a gate. Theirs are not in this repository: `make bench PEERS=folder`; without them this table stays as it was."""


def lines(calls, parts, peers):
    """The page's text and tables, of lines of Markdown each."""
    sections = ((CALLS, OF_CALLS, calls), (PARTS, OF_PARTS, parts), (PEERS, OF_PEERS, peers))
    return [line for title, words, table in sections for line in (f"## {title}", words, "", *table, "")]


def write(calls, parts, peers, sources):
    """Writes the page. peers: None where some of them were absent; then their table and the hash of the page before stay."""
    if peers is None:
        peers = [line for line in section(PAGE.held(), PEERS) if line.startswith("|")]
        sources = page_sources.hash_in(PAGE.document)
    PAGE.write(lines(calls, parts, peers), sources)
