"""The table of the twenty checks. docs/board.md holds it as `tilt board --list` prints it (host_tests/tools/tilt/test_board_page.py)."""
from typing import Callable, NamedTuple

from tilt.realboard import judges_alone, judges_motion, judges_starts, judges_wires


class Check(NamedTuple):
    """limit_s: for each thing that the program waits for; alone: there is nothing for the owner to do."""
    key: str
    do: str
    watched: str
    limit_s: int
    failing: str
    judge: Callable
    alone: bool = False


CHECKS = (
    Check("identity", "Nothing: let the board lie.",
          "`version`, `settings` and `status` are answered; the board streams without a fault", 10,
          "The board does not hear, or has a fault already: what its lines say comes first (faults.md)", judges_alone.identity, True),
    Check("rate", "Nothing: let the board lie for 30 s.",
          "rows for 30 s: none lost, their rate within 5 %, the board's clock against the PC's within 0.55 %", 30,
          "Rows lost: the USB port, a hub, a busy PC. Clock: a resonator out of its limits, or a PC that is held up", judges_alone.rate, True),
    Check("selftest", "Nothing: let the board lie.",
          "`selftest`: no axis fails", 15,
          "The sensor is damaged, no ADXL345, or not at 3.3 V", judges_alone.selftest, True),
    Check("fast_bus", "Nothing: let the board lie for 20 s, its wires as long as you use them.",
          "20 s at 800 Hz and 400 kHz: no fault, no sample lost, at most one error of the bus in 1,000 samples", 20,
          "Pull-ups too weak or wires too long for 400 kHz (wiring.md, Pull-ups)", judges_alone.fast_bus, True),
    Check("baud_rates", "Nothing: let the board lie.",
          "each baud rate that `settings` lists: 10 rows or more in 3 s, none spoilt", 30,
          "The USB bridge or its driver does not reach that rate: use another one", judges_alone.baud_rates, True),
    Check("six_faces", "Lay the sensor on each of its six sides, in any order, and leave it on each until its line appears.",
          "the length of the filtered acceleration on each side: 0.8 to 1.28 g", 180,
          "Offset or scale far out: calibrate (`cal6`), then repeat; or another sensor (ADXL343, ADXL375)", judges_motion.six_faces),
    Check("shake", "Let the board lie on a table. The program will say when to knock.",
          "20 readings or more that are 60 LSB off; afterwards the tilt is within 1 degree of what it was", 60,
          "The board has been moved; else the filter takes knocks for tilt", judges_motion.shake),
    Check("int1_wire", "Pull the wire of INT1 out of D2, so that D2 is left open. Watch the LED next to D13 (L).",
          "fault 5, 9 or 13; 80 % of the rows come without INT1; you see three flashes; then no fault, rows as before, the LED dark", 60,
          "A board without INT1 stops: please send the record in", judges_wires.int1_wire),
    Check("int1_finger", "Pull the wire of INT1 off the sensor and leave it in D2. The program will say when to hold its bare end.",
          "fault 5, 9 or 13; 80 % of the rows come for 10 s with hum on D2, no reset; then no fault, rows as before", 60,
          "Edges on an open D2 hold the board up", judges_wires.int1_finger),
    Check("sda_pulled", "Pull the SDA wire out of A4.",
          "fault 1, 3, 7, 8 or 11; rows with flag 16 meanwhile; with the wire back no fault, rows as before, no reset", 60,
          "The board hangs on an open bus, or calls what it does not see a reading", judges_wires.sda_pulled),
    Check("scl_pulled", "Pull the SCL wire out of A5.",
          "as for SDA", 60, "As for SDA", judges_wires.scl_pulled),
    Check("sda_short", "Connect A4 (SDA) to GND by the 330 ohm resistor, or by a wire; leave the sensor connected.",
          "fault 8 or 3; rows with flag 16 meanwhile; without the short no fault, rows as before, no reset", 60,
          "The board hangs on a bus that is held low", judges_wires.sda_short),
    Check("scl_short", "Connect A5 (SCL) to GND by the 330 ohm resistor, or by a wire; leave the sensor connected.",
          "fault 7 or 3; then as for SDA", 60, "As for SDA", judges_wires.scl_short),
    Check("sensor_power", "Pull the supply wire (VCC, VIN or VS) off the sensor, and let its bare end touch nothing.",
          "fault 1, 3, 4, 6, 7, 8 or 11; rows with flag 16 meanwhile; with the supply back no fault, rows as before, no reset", 60,
          "The sensor is not set up again after it lost its supply", judges_wires.sensor_power),
    Check("reset_button", "Press the reset button.",
          "a banner that names the cause `reset button or serial port opened`; rows within 5 s", 60,
          "Another cause: the supply drops as the button is pressed", judges_starts.reset_button),
    Check("reset_typing", "The program has typed half a command. Press the reset button.",
          "the other half, typed after the reset, is refused; `every` is what it was; rows as before", 60,
          "What was typed before a reset counts after it", judges_starts.reset_typing),
    Check("power_second", "Pull the USB plug for about a second and put it back. (With a bench supply: take it away, or below 2.5 V.)",
          "a banner; rows within 5 s; the saved settings are not damaged", 90,
          "The board does not start by itself, or loses what was saved", judges_starts.power_second),
    Check("eeprom_cut", "The board saves again and again. Pull the USB plug now, while it does; then put it back.",
          "`every` and `offset` are those of the last save or of the one before, never a mixture; the settings are not damaged", 90,
          "A save that is cut short destroys what was saved", judges_starts.eeprom_cut),
    Check("kept", "Let the board lie. The program will measure the mounting (`tare`), save, and say when to pull the plug for ten seconds.",
          "`level` and `every` after 8 s or more without supply are what was saved; roll and pitch within 1 degree of 0", 90,
          "The EEPROM does not keep what is saved, or the board has been moved", judges_starts.kept),
    Check("strap", "Connect D4 to GND by a wire and press the reset button.",
          "the banner says `defaults, saved ones not read`; without the wire and after another reset it does not", 90,
          "The way out of settings that cannot be reached does not work", judges_starts.strap),
)

HEAD = ("| | check | what you do | what the program watches | waits | if it fails |", "|---:|---|---|---|---:|---|")


def page_lines():
    """The table in Markdown."""
    return [*HEAD, *(f"| {number} | `{check.key}` | {check.do} | {check.watched} | {check.limit_s} s | {check.failing} |"
                     for number, check in enumerate(CHECKS, 1))]


def chosen(words):
    """The numbers and checks of 'sda_short,scl_short'; all of None. ValueError names what is none."""
    wanted = None if words is None else [word.strip() for word in words.split(",")]
    unknown = [word for word in wanted or () if word not in {check.key for check in CHECKS}]
    if unknown:
        raise ValueError(unknown[0])
    return [(number, check) for number, check in enumerate(CHECKS, 1) if wanted is None or check.key in wanted]
