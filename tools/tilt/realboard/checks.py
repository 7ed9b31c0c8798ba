"""The table of the twenty checks, printed by `tilt board --list` and held by docs/board.md (host_tests/tools/tilt/test_board_page.py)."""
from typing import Callable, NamedTuple

from tilt.realboard import judges_alone, judges_motion, judges_starts, judges_wires


class Check(NamedTuple):
    """limit_s: time limit of each wait; alone: there is nothing for the owner to do."""
    key: str
    do: str
    watched: str
    limit_s: int
    failing: str
    judge: Callable
    alone: bool = False


CHECKS = (
    Check("identity", "Nothing: let the board lie.",
          "`version`, `settings`, `status` are answered; rows come without a fault", 10,
          "The board does not answer, or reports a fault: read its lines first (faults.md)", judges_alone.identity, True),
    Check("rate", "Nothing: let the board lie for 30 s.",
          "rows for 30 s: none lost, their rate within 5 %, the board's clock against the PC's within 0.55 %", 30,
          "Rows lost: USB port, hub, or a busy PC. Clock: a bad resonator, or a busy PC", judges_alone.rate, True),
    Check("selftest", "Nothing: let the board lie.",
          "`selftest`: no axis fails", 15,
          "The sensor is damaged, not an ADXL345, or not at 3.3 V", judges_alone.selftest, True),
    Check("fast_bus", "Nothing: let the board lie for 20 s, with the wires you mean to use.",
          "20 s at 800 Hz and 400 kHz: no fault, no sample lost, at most one bus error in 1,000 samples", 20,
          "Pull-ups too weak or wires too long for 400 kHz (wiring.md, Pull-ups)", judges_alone.fast_bus, True),
    Check("baud_rates", "Nothing: let the board lie.",
          "each baud rate in `settings`: 10 rows or more in 3 s, no bad line", 30,
          "The USB bridge or its driver does not reach that rate: use another one", judges_alone.baud_rates, True),
    Check("six_faces", "Lay the sensor on each of its six sides, in any order, and leave it on each until its line appears.",
          "filtered acceleration on each side: 0.8 to 1.28 g", 180,
          "Offset or scale far out: calibrate (`cal6`), then repeat; or another sensor (ADXL343, ADXL375)", judges_motion.six_faces),
    Check("shake", "Let the board lie on a table. The program will say when to knock.",
          "20 readings or more 60 LSB off; afterwards the tilt within 1 degree of before", 60,
          "The board was moved; otherwise the filter takes knocks for tilt", judges_motion.shake),
    Check("int1_wire", "Pull the wire of INT1 out of D2, so that D2 is left open. Watch the LED next to D13 (L).",
          "fault 5, 9 or 13; 80 % of the rows; you see three flashes; then no fault, the LED dark", 60,
          "The board stops without INT1: please send in the record", judges_wires.int1_wire),
    Check("int1_finger", "Pull the wire of INT1 off the sensor and leave it in D2. The program will say when to hold its bare end.",
          "fault 5, 9 or 13; 80 % of the rows for 10 s with hum on D2, no reset; then no fault", 60,
          "Edges on an open D2 stall the board", judges_wires.int1_finger),
    Check("sda_pulled", "Pull the SDA wire out of A4.",
          "fault 1, 3, 7, 8 or 11; rows with flag 16 meanwhile; with the wire back no fault, no reset", 60,
          "The board hangs on an open bus, or takes garbage for readings", judges_wires.sda_pulled),
    Check("scl_pulled", "Pull the SCL wire out of A5.",
          "as for SDA", 60, "As for SDA", judges_wires.scl_pulled),
    Check("sda_short", "Connect A4 (SDA) to GND by the 330 ohm resistor, or by a wire; leave the sensor connected.",
          "fault 8 or 3; rows with flag 16 meanwhile; without the short no fault, no reset", 60,
          "The board hangs on a bus that is held low", judges_wires.sda_short),
    Check("scl_short", "Connect A5 (SCL) to GND by the 330 ohm resistor, or by a wire; leave the sensor connected.",
          "fault 7 or 3; then as for SDA", 60, "As for SDA", judges_wires.scl_short),
    Check("sensor_power", "Pull the supply wire (VCC, VIN or VS) off the sensor. Its bare end must touch nothing.",
          "fault 1, 3, 4, 6, 7, 8 or 11; rows with flag 16 meanwhile; with the supply back no fault, no reset", 60,
          "The sensor is not configured again after losing its supply", judges_wires.sensor_power),
    Check("reset_button", "Press the reset button.",
          "a banner with the cause `reset button or serial port opened`; rows within 5 s", 60,
          "Another cause: the supply drops as you press the button", judges_starts.reset_button),
    Check("reset_typing", "The program has typed half a command. Press the reset button.",
          "the other half, typed after the reset, is refused; `every` unchanged", 60,
          "Text typed before a reset still counts after it", judges_starts.reset_typing),
    Check("power_second", "Pull the USB plug for about a second and put it back. (With a bench supply: switch off, or below 2.5 V.)",
          "a banner; rows within 5 s; saved settings undamaged", 90,
          "The board does not start by itself, or loses saved settings", judges_starts.power_second),
    Check("eeprom_cut", "The board saves again and again. Pull the USB plug now, while it does; then put it back.",
          "`every` and `offset` are from the last save or the one before, never mixed; settings undamaged", 90,
          "A save cut short destroys the saved settings", judges_starts.eeprom_cut),
    Check("kept", "Let the board lie. The program will measure the mounting (`tare`), save, and say when to pull the plug for ten seconds.",
          "`level` and `every` after 8 s or more without supply as saved; roll and pitch within 1 degree of 0", 90,
          "The EEPROM loses saved settings, or the board was moved", judges_starts.kept),
    Check("strap", "Connect D4 to GND by a wire and press the reset button.",
          "the banner says `defaults, saved ones not read`; not after a reset without the wire", 90,
          "The way out of unreachable settings does not work", judges_starts.strap),
)

HEAD = ("| | check | what you do | what the program watches |", "|---:|---|---|---|")


def page_lines():
    """The table in Markdown. What a failure means is printed when a check fails."""
    return [*HEAD, *(f"| {number} | `{check.key}` | {check.do} | {check.watched} |" for number, check in enumerate(CHECKS, 1))]


def chosen(words):
    """The numbers and checks of 'sda_short,scl_short'; all of None. ValueError names an unknown check."""
    wanted = None if words is None else [word.strip() for word in words.split(",")]
    unknown = [word for word in wanted or () if word not in {check.key for check in CHECKS}]
    if unknown:
        raise ValueError(unknown[0])
    return [(number, check) for number, check in enumerate(CHECKS, 1) if wanted is None or check.key in wanted]
