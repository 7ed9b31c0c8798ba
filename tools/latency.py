"""How long an interrupt of the firmware may wait, by what is on the serial line; for the fault campaign and host_tests/system_passes.py."""
import math

LATENCY_CYCLES = 245  # 15.3 us: the clock, behind main with interrupts off (100) and one data-ready (145)

# I2C is served last. It has no deadline: SCL stays low meanwhile. Where bytes are quick the handlers of all others meet now and then.
ONCE_CYCLES = 100 + 145 + 83 + 13  # main with interrupts off, data-ready, the clock, the alarm
BYTE_IN_CYCLES, BYTE_OUT_CYCLES = 66, 52
# the others have no deadline: the next byte to send, and the alarm, which only wakes main
WITH_DEADLINE = ("int0", "twi", "timer1_compa", "usart_rx")


def longest_wait_of_twi(baud, flood):
    """Cycles: all others once, and a byte out each time the line has sent one; a byte in too, or a single one without a flood."""
    per_byte = BYTE_OUT_CYCLES + flood * BYTE_IN_CYCLES
    once = ONCE_CYCLES + (not flood) * BYTE_IN_CYCLES
    wait, longer = 0, once
    while longer > wait:
        wait = longer
        longer = once + per_byte * math.ceil(wait * baud / 160e6)
    return wait


def waits(stats, baud, flood):
    """(interrupt, its longest wait, limit), in cycles, of what simrun says of a run."""
    for name in WITH_DEADLINE:
        yield name, stats.get(f"isr_{name}_worst_latency", 0), longest_wait_of_twi(baud, flood) if name == "twi" else LATENCY_CYCLES
