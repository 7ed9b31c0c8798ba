"""Checks in which the owner pulls or shorts a wire of the sensor."""
from tilt.realboard import watch
from tilt.realboard.bench import Failed

NO_SENSOR, BUS, READ_BACK, INT1_LOW, NO_DATA, SCL_LOW, SDA_LOW, INT1_HIGH, TORN, INT1_FLICKERS = 1, 3, 4, 5, 6, 7, 8, 9, 11, 13  # docs/faults.md
INT1_S = 5.0          # of rows without INT1
FINGER_S = 10.0
ROWS_SHARE = 0.8      # of the nominal number: the sensor is read by the clock, so a row may be a prediction


def int1_wire(bench):
    """D2 floats: rows continue, the LED shows three flashes."""
    watch.fault_begins(bench, (INT1_LOW, INT1_HIGH, INT1_FLICKERS))
    rows_without_int1(bench, INT1_S)
    if not bench.ask("Does the LED repeat three flashes and a pause?"):
        raise Failed("the LED does not flash three times")
    bench.say("   Now put the wire back into D2.")
    watch.well_again(bench)
    if not bench.ask("Is the LED dark now?"):
        raise Failed("the LED is not dark although the fault is over")


def int1_finger(bench):
    """A finger on the floating wire: hum on D2, and rows continue."""
    watch.fault_begins(bench, (INT1_LOW, INT1_HIGH, INT1_FLICKERS))
    bench.say(f"   Now hold the bare end between two fingers for {FINGER_S:.0f} s.")
    is_over = rows_without_int1(bench, FINGER_S)
    bench.say("   Now put the wire back on INT1 of the sensor.")
    watch.well_again(bench, is_over)


def rows_without_int1(bench, seconds):
    """The sensor is read by the clock: True if the fault is over at the end. The fault may change its number, end and return, as hum resembles
    data-ready; the board must not stop or restart."""
    found, is_over = watch.Stretch(), False
    for seen in bench.events(seconds):
        watch.not_reset(seen)
        found.add(seen)
        is_over = is_over if watch.fault_state(seen) is None else watch.fault_state(seen)
    shown = len(found.rows) - found.silent
    bench.measured(rows_without_int1=shown, predicted_without_int1=found.silent)
    if found.board_s < watch.HEARD_SHARE * seconds or shown < ROWS_SHARE * watch.RATE_HZ * found.board_s:
        raise Failed(f"only {shown} rows with a sample in {seconds:.0f} s without INT1 ({found.board_s:.1f} s by the board's clock)")
    return is_over


def broken_bus(faults, back):
    """A judge: one of these faults is reported, rows carry the flag for no sample meanwhile, and the repair clears the fault."""
    def judge(bench):
        watch.fault_begins(bench, faults)
        bench.say(f"   Now {back}.")
        if not watch.well_again(bench):
            raise Failed("no row has flag 16 (no sample)")
    return judge


# a floating wire may read low, and bounces: the first fault may be any of these
sda_pulled = broken_bus((NO_SENSOR, BUS, SDA_LOW, SCL_LOW, TORN), "put SDA back into A4")
scl_pulled = broken_bus((NO_SENSOR, BUS, SCL_LOW, SDA_LOW, TORN), "put SCL back into A5")
sda_short = broken_bus((SDA_LOW, BUS), "take the short away")
scl_short = broken_bus((SCL_LOW, BUS), "take the short away")
# without its supply the sensor loads the lines, or is powered through them
sensor_power = broken_bus((NO_SENSOR, BUS, READ_BACK, NO_DATA, SCL_LOW, SDA_LOW, TORN), "reconnect the sensor's supply")
