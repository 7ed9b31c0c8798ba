"""No pass of the main loop is longer than 4 ms, and no interrupt with a deadline waits longer than 15.5 us; part of system_tests.py."""
import pathlib
import re

from laws import DEFAULT, LIGHT, ROBUST  # noqa: E402
import latency  # noqa: E402
from system_support import SET_IMAGES, STREAMS, TESTS, image_with, simrun, start_offset_us, test, triplets, within  # noqa: E402

PASS_CYCLES = 64000
COMMANDS = ("status", "help", "filter {0}", "range 8", "filter", "filter {1}", "range 16", "every 3", "every 1", "stop", "go", "mode plot",
            "nonsense", "filter {0}", "mode csv", "rate 50", "rate {2}", "filter {1}", "status")
# with what each is answered by, begun anywhere: settings, calibration and measurements, each told of, in this order
SETTING_COMMANDS = (("settings", "# level "), ("level 0.5 0.5 0.7", "# level 0.5 0.5 0.7"), ("axes -yxz", "# axes -yxz"), ("odr", "# odr "),
                    ("offset -79.9375 64.0625 33", "# offset -79.9375"), ("scale 200.5 329.25 256", "# scale 200.5"), ("cal6", "# cal6: hold still"),
                    ("tare", "# refused 10"), ("cal6 stop", "# cal6: stopped"), ("noise", "# noise: hold still"), ("stop", "# stopped"),
                    ("save", "# saved"), ("load", "# settings: as saved"), ("go", "# going"), ("save", "# saved"),
                    ("selftest", "# selftest: hold still"), ("settings", "# scale "), ("address 53", "# address 53"),
                    ("defaults", "# settings: defaults"))
FAULTS = ("unplug:60", "power:20", "scl:40", "sda:40", "hang:5", "noint:60", "nack", "nackdata", "buserr", "arb", "devid:0:60", "storm:1000:30",
          "txstall:60")
# rate, baud: a flood without pause leaves a processor at 1,000,000 baud too little for anything
PACES = ((100, 115200, True), (800, 1000000, False), (400, 500000, True))


def filters_of(image):
    return pathlib.Path(image).with_name("filters.txt").read_text(encoding="ascii").split()


def assert_prompt(name, stats, baud, flood):
    assert stats["passes"] > 100, stats["passes"]
    within(f"{name}: pass of the main loop", stats["pass_max_cycles"], PASS_CYCLES)
    for source, cycles, limit in latency.waits(stats, baud, flood):
        within(f"{name}: latency of {source}", cycles, limit)


def disturbed_run(image, filter_name, rate, baud, flood):
    """Every command, then every fault, 130 and 300 ms apart, the filter changed to and fro."""
    other = next((f for f in filters_of(image) if f != filter_name), filter_name)
    options = []
    for i, text in enumerate(COMMANDS):
        options += ["--cmd", f"{1000 + 130 * i}:{text.format(other, filter_name, rate)}"]
    for i, fault in enumerate(FAULTS + (("rxflood:60",) if flood else ())):
        options += ["--fault", f"{3700 + 300 * i}ms:{fault}"]
    name = f"passes-{pathlib.Path(image).parent.name}-{filter_name}-{rate}"
    _, _, _, stats = simrun(name, STREAMS / "outliers-15pct.csv", "--filter", filter_name, "--rate", rate, "--baud", baud, "--loop", "--max-ms",
                            8200, *options, fw=image, judge=False)
    assert_prompt(name, stats, baud, flood)


def make_disturbed_test(image, rate, baud, flood):
    def check():
        for filter_name in filters_of(image):
            disturbed_run(image, filter_name, rate, baud, flood)
    check.__name__ = f"no_pass_longer_than_4_ms_{pathlib.Path(image).parent.name}_{rate}_hz"
    return check


def settings_run(image, rate, baud):
    """Settings, calibration, EEPROM and measurements on a stream with outliers; each command must have been run."""
    name = f"passes-settings-{pathlib.Path(image).parent.name}-{rate}"
    options = [word for i, (text, _) in enumerate(SETTING_COMMANDS) for word in ("--cmd", f"{1000 + 400 * i}:{text}")]
    _, notes, _, stats = simrun(name, STREAMS / "outliers-15pct.csv", "--filter", filters_of(image)[0], "--rate", rate, "--baud", baud, "--loop",
                                "--max-ms", 9000, *options, fw=image, judge=False)
    begins = 0
    for text, answer in SETTING_COMMANDS:
        found = [i for i, note in enumerate(notes) if i >= begins and note.startswith(answer)]
        assert found, f"{text}: no {answer} from note {begins} on: {notes}"
        begins = found[0]
    assert_prompt(name, stats, baud, False)


def make_settings_test(image, rate, baud):
    def check():
        settings_run(image, rate, baud)
    check.__name__ = f"no_pass_longer_than_4_ms_in_settings_{pathlib.Path(image).parent.name}_{rate}_hz"
    return check


for set_image in SET_IMAGES:
    for pace in PACES:
        TESTS.append(make_disturbed_test(set_image, *pace))
        TESTS.append(make_settings_test(set_image, *pace[:2]))


@test
def flood_at_1000000_baud_while_help_holds_the_rows_costs_no_sample():
    """100 bytes a millisecond, from the first lines of help on: what does not fit is counted, its lines are refused, rows held are counted."""
    for rate in (100, 400):
        rows, notes, served, stats = simrun(f"passes-flood-{rate}", STREAMS / "rest-2lsb.csv", "--rate", rate, "--baud", 1000000,
                                            "--cmd", "1000:help", "--fault", "1003ms:rxflood:1500", "--cmd", "2800:x", "--cmd", "2900:status",
                                            "--max-ms", 3300)
        assert stats["isr_usart_rx_n"] >= 99 * 1500, stats["isr_usart_rx_n"]
        assert_prompt(f"flood at {rate} Hz", stats, 1000000, True)
        first = next(i for i, row in enumerate(rows) if row[0] > 1000000)
        assert rows[first][9] & 256 and not any(row[9] & 256 for row in rows[first + 1:]), rows[first:first + 5]
        shown = [row[1:4] for row in rows[first:] if row[0] <= 2800000]
        latched = min(range(len(served)), key=lambda i: abs(int(served[i]["t_us"]) - start_offset_us(served, rows) - rows[first][0]))
        assert shown == triplets(served)[latched:latched + len(shown)] and len(shown) >= 1.75 * rate, (len(shown), "every sample has its row")
        told = " ".join(notes[notes.index(next(note for note in notes if note.startswith("# state "))):])
        samples, sent, held, bytes_lost, refused, lost = (int(n) for n in re.search(
            r"samples (\d+),.* rows (\d+), dropped 0, held (\d+), serial bytes lost (\d+), lines refused (\d+) # lost (\d+),", told).groups())
        assert abs(sent + held - samples) <= 1 and held > 0 and bytes_lost > 0 and lost == 0, (told, "a row may come between two lines")
        assert 0 <= refused - sum(note.startswith("# refused ") for note in notes) <= 1, (refused, "the last line may be refused for its rest")


@test
def a_row_waits_for_one_axis_of_a_change_of_filter():
    """10 ms and what a line may take are 18, as in the fault campaign; all three axes ahead of one sample would make it 24 to 29."""
    for phase in range(10):
        name = f"change-{phase}"
        _, notes, _, stats = simrun(name, STREAMS / "rest-2lsb.csv", "--filter", ROBUST, "--max-ms", 2000, "--cmd", f"{980 + phase}:filter {LIGHT}",
                                    "--cmd", f"{1480 + phase}:filter {ROBUST}", "--fault", "800ms:nack",  # the gap is that behind it
                                    fw=image_with(ROBUST), judge=False)
        assert stats["rows_wrong"] == stats["lost"] == 0 and stats["rows_calm_gap_ms"] > 10, stats
        assert f"# filter {LIGHT}" in notes and f"# filter {ROBUST}" in notes, notes
        within(f"{name}: ms from row to row", stats["rows_calm_gap_ms"], 18)


@test
def no_pass_longer_than_4_ms_in_any_stream():
    for stream in sorted(STREAMS.glob("*.csv")):
        for rate, baud in ((12.5, 115200), (100, 115200), (400, 1000000), (800, 1000000)):
            name = f"passes-{stream.stem}-{rate}"
            _, _, _, stats = simrun(name, stream, "--rate", rate, "--baud", baud, "--loop", "--max-ms", 5000, fw=image_with(DEFAULT), judge=False)
            assert_prompt(name, stats, baud, False)
