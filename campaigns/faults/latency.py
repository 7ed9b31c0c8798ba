"""How long an interrupt of the firmware may wait, by what is on the serial line; for the fault campaign and host_tests/system/system_passes.py."""
import math

LATENCY_CYCLES = 248  # 15.5 us; the second byte that waits at 1,000,000 baud is lost after 20

# The longest way through each handler, entry and return included, and the longest stretch of main with interrupts off. Between two of
# them main carries out one instruction, of BETWEEN_CYCLES at most; where that is cli, the stretch comes next.
MAIN_OFF_CYCLES, DATA_READY_CYCLES, CLOCK_CYCLES, ALARM_CYCLES, I2C_CYCLES = 19, 138, 96, 13, 97
DATA_READY_BUSY_CYCLES = 114  # while a transfer is on the bus it only keeps its time
BYTE_IN_CYCLES, BYTE_DAMAGED_CYCLES, BYTE_OUT_CYCLES = 66, 79, 55
BETWEEN_CYCLES = RESPONSE_CYCLES = 4

# The clock waits for a handler that has begun, for main and for one data-ready; the limit of all that have a deadline is above that.
CLOCK_WAITS_CYCLES = MAIN_OFF_CYCLES + 2 * BETWEEN_CYCLES + RESPONSE_CYCLES + max(BYTE_DAMAGED_CYCLES + DATA_READY_CYCLES,
                                                                                I2C_CYCLES + DATA_READY_BUSY_CYCLES)

# I2C is served last. It has no deadline: SCL stays low meanwhile. It waits for each other handler once, at any speed of the line: the
# clock, data-ready and a byte out alone, 289 cycles, are more than the limit of the others.
ONCE_CYCLES = MAIN_OFF_CYCLES + DATA_READY_CYCLES + CLOCK_CYCLES + ALARM_CYCLES + 4 * BETWEEN_CYCLES + RESPONSE_CYCLES
# the others have no deadline: the next byte to send, and the alarm, which only wakes main
WITH_DEADLINE = ("int0", "twi", "timer1_compa", "usart_rx")


def longest_wait_of_twi(baud, flood):
    """Cycles: all others once, and a byte out each time the line has sent one; a byte in too, or a single one without a flood."""
    per_byte = BYTE_OUT_CYCLES + BETWEEN_CYCLES + flood * (BYTE_IN_CYCLES + BETWEEN_CYCLES)
    once = ONCE_CYCLES + (not flood) * (BYTE_DAMAGED_CYCLES + BETWEEN_CYCLES)
    wait, longer = 0, once
    while longer > wait:
        wait = longer
        longer = once + per_byte * math.ceil(wait * baud / 160e6)
    return wait


def waits(stats, baud, flood):
    """(interrupt, its longest wait, limit), in cycles, of what simrun says of a run."""
    for name in WITH_DEADLINE:
        yield name, stats.get(f"isr_{name}_worst_latency", 0), longest_wait_of_twi(baud, flood) if name == "twi" else LATENCY_CYCLES
