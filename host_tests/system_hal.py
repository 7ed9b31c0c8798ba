"""The hal of the ATmega328P by the data sheet's rules, which simrun holds in each run; part of system_tests.py."""
from system_support import OUT, SIMRUN, STREAMS, run, test

HAL = [f"hal/avr/hal_{name}.c" for name in ("uart", "time", "sleep", "watchdog", "i2c")]


def probe(name, status, sources=HAL):
    """What a program of host_tests/avr sends, and what simrun says at its end."""
    elf, out = OUT / f"{name}.elf", OUT / f"{name}.txt"
    run("avr-gcc", "-std=gnu11", "-mmcu=atmega328p", "-DF_CPU=16000000UL", "-Os", "-Ihal", "-Ihal/avr", f"host_tests/avr/{name}.c", *sources,
        "-o", elf)
    done = run(SIMRUN, "--fw", elf, "--in", STREAMS / "tilt-fast.csv", "--out", out, "--max-ms", "2000", expect=status)
    return out.read_text(encoding="ascii"), done.stderr


def planted(file, old, new):
    """A copy of a file of the hal with a fault in it, beside its headers."""
    text = open(file, encoding="utf-8").read()
    assert text.count(old) == 1, f"{file} has {old!r} {text.count(old)} times"
    path = OUT / file.rpartition("/")[2]
    path.write_text(text.replace(old, new), encoding="utf-8")
    return [path if source == file else source for source in HAL]


@test
def line_is_idle_when_its_last_stop_bit_is_out():
    """A frame that ends at any cycle around the next byte: 80 steps, one, two or three bytes behind it; each byte arrives."""
    said, _ = probe("uart_probe", 8)
    assert said == "ab" * 80 + "abb" * 80 + "abbbc" * 80 + "\n", (len(said), said[:80])


@test
def line_that_is_idle_too_early_is_found():
    for old, new in (('"sts %[ucsra], r24\\n"', '""'), ("        UCSR0A = SENDS_LAST;", "        ;"),
                     (" && (!line_used || (UCSR0A & _BV(TXC0)))", "")):
        _, said = probe("uart_probe", 6, planted("hal/avr/hal_uart.c", old, new))
        assert "the UART's divider was changed while a byte was on its way" in said, said
    _, said = probe("uart_probe", 6, planted("hal/avr/hal_uart.c", "if (UCSR0A & _BV(UDRE0))", "if (true)"))
    assert "a byte was written to the UART before it was ready" in said, said
