"""The hal of the ATmega328P by the data sheet's rules, which simrun holds in each run; part of system_tests.py."""
import pathlib
import re

from system_support import OUT, SIMRUN, STREAMS, run, simrun, test

HAL = [f"hal/avr/hal_{name}.c" for name in ("uart", "time", "sleep", "watchdog", "i2c", "eeprom")]


def probe(name, status, plant=None, resets=0):
    """What a program of host_tests/chip sends, and what simrun says at its end; plant: (file of the hal, text, another in its place)."""
    elf, out, folder, sources = OUT / f"{name}.elf", OUT / f"{name}.txt", OUT / "planted", list(HAL)
    folder.mkdir(exist_ok=True)
    if plant is not None:
        file, old, new = plant
        text = pathlib.Path(file).read_text(encoding="utf-8")
        assert text.count(old) == 1, f"{file} has {old!r} {text.count(old)} times"
        path = folder / pathlib.Path(file).name
        path.write_text(text.replace(old, new), encoding="utf-8")
        sources = [path if source == file else source for source in HAL]
    run("avr-gcc", "-std=gnu11", "-mmcu=atmega328p", "-DF_CPU=16000000UL", "-Os", f"-I{folder}", "-Ihal", "-Ihal/avr", "-Ilib/machine/src",
        f"host_tests/chip/{name}.c", *sources, "-o", elf)
    done = run(SIMRUN, "--fw", elf, "--in", STREAMS / "tilt-fast.csv", "--out", out, "--max-ms", "2000", "--expect-resets", resets,
               expect=status)
    return out.read_text(encoding="ascii"), done.stderr


@test
def line_is_idle_when_its_last_stop_bit_is_out():
    """A frame that ends at any cycle around the next byte: 80 steps, one, two or three bytes after it; each byte arrives."""
    said, _ = probe("uart_probe", 8)
    assert said == "ab" * 80 + "abb" * 80 + "abbbc" * 80 + "\n", (len(said), said[:80])


@test
def line_that_is_idle_too_early_is_found():
    for old, new in (('"sts %[ucsra], r24\\n"', '""'), (" && (!line_used || (UCSR0A & _BV(TXC0)))", "")):
        _, said = probe("uart_probe", 6, ("hal/avr/hal_uart.c", old, new))
        assert "the UART's divider was changed while a byte was on its way" in said, said
    _, said = probe("uart_probe", 6, ("hal/avr/hal_uart.c", "UCSR0B |= _BV(UDRIE0);", "UDR0 = 0;\n    UCSR0B |= _BV(UDRIE0);"))
    assert "a byte was written to the UART before it was ready" in said, said


TIMER, SLEEP = "a 16-bit register of Timer1 is used with interrupts on", "SLEEP does not follow the SEI"
EEPROM = "an EEPROM byte is written with interrupts on"
BITES = "the watchdog is on with its shortest period since it bit"
OPEN = "    WDTCSR = _BV(WDCE) | _BV(WDE);\n"  # four cycles for the write that changes it
EIGHT_BITS = "UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);"
RULES = (
    ("hal_probe", "hal/avr/hal_uart.c", EIGHT_BITS, "UCSR0C = _BV(UCSZ01);", "the UART's frame is not 8N1"),
    ("hal_probe", "hal/avr/hal_uart.c", EIGHT_BITS, "UCSR0C = _BV(UCSZ01) | _BV(UCSZ00) | _BV(USBS0);", "the UART's frame is not 8N1"),
    ("hal_probe", "hal/avr/hal_sleep.c", "        cli();\n", "", SLEEP),
    ("hal_probe", "hal/avr/hal_sleep.c", "        sei();\n        sleep_cpu", "        sei();\n        __builtin_avr_nop();\n        sleep_cpu",
     SLEEP),
    ("hal_probe", "hal/avr/hal_sleep.c", "    SMCR = _BV(SE);\n", "", "SLEEP without SE in SMCR"),
    ("hal_probe", "hal/avr/hal_time.c", "hal_irq_save();\n    uint16_t since", "SREG;\n    uint16_t since", TIMER),
    ("hal_probe", "hal/avr/hal_time.c", "hal_irq_save(); /* the timer", "SREG; /* the timer", TIMER),
    ("hal_probe", "hal/avr/hal_eeprom.c", "hal_irq_save();\n    EECR", "SREG;\n    EECR", EEPROM),
    ("hal_probe", "hal/avr/hal_eeprom.c", "EECR |= _BV(EEMPE);\n", "EECR |= _BV(EEMPE);\n    __builtin_avr_delay_cycles(6);\n",
     "EEPE is set more than four cycles after EEMPE"),
    ("hal_probe", "hal/avr/hal_i2c.c", "    for (uint8_t clocks", "    TWCR = _BV(TWIE);\n    for (uint8_t clocks",
     "the two-wire interrupt is enabled without the interface"),
    ("watchdog_probe", "hal/avr/hal_watchdog.c", "    MCUSR = 0;\n", "", BITES),
    *(("watchdog_probe", "hal/avr/hal_watchdog.c", "    wdt_disable();\n", instead, BITES) for instead in (
        "", "    WDTCSR = 0;\n", OPEN, f"{OPEN}    WDTCSR = _BV(WDE);\n", "    WDTCSR = _BV(WDCE);\n    WDTCSR = 0;\n",
        f"{OPEN}    __builtin_avr_delay_cycles(4);\n    WDTCSR = 0;\n")),
)


@test
def broken_rule_of_the_data_sheet_ends_the_run():
    for name, file, old, new, words in RULES:
        _, said = probe(name, 11, (file, old, new))
        assert f"status 11: {words}" in said, (file, old, said)


@test
def start_after_the_watchdog_bit_may_take_its_time():
    quarter_s = f"{OPEN}    WDTCSR = _BV(WDE) | _BV(WDP2);\n    wdt_reset();\n"
    for instead in ("    wdt_disable();\n", f"{OPEN}    WDTCSR = 0;\n", quarter_s):
        said, _ = probe("watchdog_probe", 8, ("hal/avr/hal_watchdog.c", "    wdt_disable();\n", instead), resets=2)
        assert said == "033", (instead, said)  # power on, then two bites (hal_watchdog.h)


@test
def causes_of_resets_add_up_until_they_are_cleared():
    """A one leaves the flag of the power-on, which counts before others: the probe never learns that it was bitten."""
    said, _ = probe("watchdog_probe", 7, ("hal/avr/hal_watchdog.c", "    MCUSR = 0;\n", "    MCUSR = _BV(PORF);\n"), resets=2)
    assert len(said) > 3 and set(said) == {"0"}, said


@test
def divider_is_the_nearest_to_each_baud_rate():
    for baud in (9600, 19200, 38400, 57600, 115200, 250000, 500000, 1000000):
        _, _, _, stats = simrun("divider", STREAMS / "rest-2lsb.csv", "--baud", baud, "--max-ms", "600")
        nearest = min((2e6 / divider for divider in range(1, 4097)), key=lambda rate: abs(rate - baud))
        assert abs(stats["uart_baud"] - nearest) <= 1, (baud, stats["uart_baud"], nearest)


@test
def led_on_d13_flashes_as_often_as_the_fault_says():
    """A second of the LED has 8 slots of 131 ms, of which the first ones flash: three of its seconds begin within 3 s."""
    for fault, flashes in (("0ms:sda", 1), ("0ms:unplug", 2), ("0ms:noint", 3), ("0ms:frozen", 4)):
        _, _, _, stats = simrun("led", STREAMS / "rest-2lsb.csv", "--fault", fault, "--max-ms", "3000")
        late = 1 if fault == "0ms:frozen" else 0  # ten readings are needed: the first flash is over by then
        assert 3 * flashes - late <= stats["led_flashes"] <= 3 * flashes, (fault, stats["led_flashes"])
    assert simrun("led", STREAMS / "rest-2lsb.csv", "--max-ms", "3000")[3]["led_flashes"] == 0


@test
def start_waits_for_a_stop_that_is_held_back():
    """SCL is held low around the end of a burst, so that its STOP waits, and until after the next sample is ready."""
    _, _, served, _ = simrun("stop", STREAMS / "rest-2lsb.csv", "--max-ms", "560")
    ready_us = next(int(sample["t_us"]) for sample in served if int(sample["t_us"]) > 500000)
    for late_us in range(376, 402, 2):
        simrun("stop", STREAMS / "rest-2lsb.csv", "--fault", f"{(ready_us + late_us) / 1000:.3f}ms:scl:12", "--max-ms", "560")


@test
def line_with_a_damaged_or_lost_byte_is_refused_and_the_next_is_not():
    """`every 1000` without its first 0 would be obeyed as `every 100`: each byte of the line, without a stop bit or after a lost one."""
    line = "every 1000"
    for lost in (0, 1):
        for at in range(len(line)):
            # ten bits of 8.5 us; the line is typed from 400 ms on
            _, notes, _, _ = simrun("spoilt", STREAMS / "rest-2lsb.csv", "--cmd", f"400:{line}", "--cmd", "450:every 2", "--cmd", "500:status",
                                    "--fault", f"{399.96 + 0.085 * at:.3f}ms:rxspoil:{lost}", "--max-ms", "600")
            assert "# refused 3: illegal characters" in notes and "# every 2" in notes, (lost, at, notes)
            assert not any(note.startswith("# every 100") for note in notes), (lost, at, notes)
            assert any("serial bytes lost 1, lines refused 1" in note for note in notes), (lost, at, notes)


def bytes_put_in(header):
    """Those that the code of ring_probe.c puts into its slot, with this text as hal_ring.h."""
    folder = OUT / "ring"
    folder.mkdir(exist_ok=True)
    (folder / "hal_ring.h").write_text(header, encoding="utf-8")
    run("avr-gcc", "-std=gnu11", "-mmcu=atmega328p", "-Os", "-S", f"-I{folder}", "host_tests/chip/ring_probe.c", "-o", folder / "ring_probe.s")
    code = (folder / "ring_probe.s").read_text(encoding="ascii")
    return [int(value) & 0xFF for value in re.findall(r"\tldi r\d+,lo8\((-?\d+)\)\n", code)]


@test
def byte_of_a_ring_is_there_before_its_index_says_so():
    """An interrupt may look at every commit: no store from before it is put off, or dropped for a later one."""
    header = pathlib.Path("hal/hal_ring.h").read_text(encoding="utf-8")
    fence = '__asm__ volatile("" ::: "memory")'
    assert header.count(fence) == 1
    assert bytes_put_in(header) == [0x55, 0xAA]
    assert bytes_put_in(header.replace(fence, "(void)0")) == [0xAA]
