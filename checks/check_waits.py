#!/usr/bin/env python3
"""How long interrupts may be held up: the longest way through each handler and each stretch of main with interrupts off, in cycles of
the instructions of the image, against what campaigns/faults/latency.py reckons with.

    check_waits.py ELF...
"""
import pathlib
import re
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import latency
from avr_objects import symbols
from check_support import Stop, binding, main, report, run

# cycles of an instruction (data sheet, "Instruction Set Summary"); all others take one, a branch that is taken one more
CYCLES = {**dict.fromkeys("push pop lds sts ld ldd st std adiw sbiw mul muls mulsu fmul fmuls fmulsu rjmp ijmp sbi cbi".split(), 2),
          **dict.fromkeys("jmp rcall icall lpm".split(), 3), **dict.fromkeys("call ret reti".split(), 4)}
SKIPS = {"cpse", "sbrc", "sbrs", "sbic", "sbis"}
RESPONSE = latency.RESPONSE_CYCLES
TWCR, SREG_IO, SREG_MEMORY = "0x00BC", "0x3f", "0x5F"
# simrun knows no handler but these
HANDLERS = {"__vector_1": ("data-ready", latency.DATA_READY_CYCLES), "__vector_11": ("clock", latency.CLOCK_CYCLES),
            "__vector_12": ("alarm", latency.ALARM_CYCLES), "__vector_18": ("byte in", latency.BYTE_DAMAGED_CYCLES),
            "__vector_19": ("byte out", latency.BYTE_OUT_CYCLES), "__vector_24": ("I2C", latency.I2C_CYCLES)}
# run before interrupts are on, or never
NO_SECTIONS = {"hal_watchdog_early", "_exit"}


class Code:
    """An image's instructions: {address: (operation, operands, bytes, target, function)}."""

    def __init__(self, elf):
        self.at, self.entry, function = {}, {}, ""
        for line in run("avr-objdump", "-d", elf).splitlines():
            title = re.match(r"([0-9a-f]{8}) <(.+)>:", line)
            if title:
                function = title.group(2)
                self.entry[function] = int(title.group(1), 16)
                continue
            found = re.match(r" *([0-9a-f]+):\t((?:[0-9a-f]{2} )+)\s*\t(\S+)\s*([^;]*)", line)
            if found:
                address, size, operation, operands = int(found.group(1), 16), len(found.group(2).split()), found.group(3), found.group(4).strip()
                self.at[address] = (operation, operands, size, self.target(address, operation, operands), function)
        found = {name for name in self.entry if re.fullmatch(r"__vector_\d+", name)}
        if found != set(HANDLERS):
            raise Stop(f"{elf}: handlers missing or not reckoned with: {', '.join(sorted(found ^ set(HANDLERS)))}")

    @staticmethod
    def target(address, operation, operands):
        if re.match(r"br(?!eak)|rjmp|rcall", operation):
            return address + 2 + int(operands.lstrip("."))
        return int(operands, 16) if operation in ("jmp", "call") else None

    def following(self, address):
        """[(next address, cycles)] of an instruction that neither calls nor returns."""
        operation, _, size, target, _ = self.at[address]
        beyond = address + size
        if operation.startswith("br"):
            return [(beyond, 1), (target, 2)]
        if operation in SKIPS:
            skipped = self.at[beyond][2]
            return [(beyond, 1), (beyond + skipped, 1 + skipped // 2)]
        if operation in ("ijmp", "icall", "sleep"):
            raise Stop(f"{address:x} {operation}: where it leads to cannot be told")
        return [(target if operation in ("rjmp", "jmp") else beyond, CYCLES.get(operation, 1))]

    def longest(self, address, ends, shuns=lambda address: False):
        """Cycles of the longest way to an instruction that ends it, that included; None if every way meets one that is shunned."""
        known = {}

        def way(here, back):
            if (here, back) not in known:
                known[here, back] = "running"
                known[here, back] = further(here, back)
            if known[here, back] == "running":
                raise Stop(f"{here:x} in {self.at[here][4]}: a loop where interrupts are off")
            return known[here, back]

        def further(here, back):
            operation, _, size, target, _ = self.at[here]
            if shuns(here):
                return None
            if ends(here):
                return CYCLES.get(operation, 1)
            if operation in ("call", "rcall"):
                steps = [(target, CYCLES[operation], (*back, here + size))]
            elif operation == "ret":
                if not back:
                    raise Stop(f"{here:x} in {self.at[here][4]}: returns with interrupts off")
                steps = [(back[-1], CYCLES["ret"], back[:-1])]
            else:
                steps = [(next_one, cycles, back) for next_one, cycles in self.following(here)]
            ways = [(cycles, way(next_one, stack)) for next_one, cycles, stack in steps]
            return max((cycles + rest for cycles, rest in ways if rest is not None), default=None)
        return way(address, ())

    def returns(self, address):
        return self.at[address][0] == "reti"

    def loaded(self, address, register, value):
        """The last instruction before it, in its function and with no call between, that writes a register loads this constant."""
        function = self.at[address][4]
        for before in range(address - 2, address - 60, -2):
            operation, operands = self.at.get(before, ("", ""))[:2]
            if before not in self.at:
                continue  # the second word of an instruction
            if self.at[before][4] != function or operation in ("call", "rcall"):
                return False
            first = operands.partition(",")[0]
            pair = operation in ("movw", "adiw", "sbiw") and first == "r30"
            if first == register or pair or "Z+" in operands or "-Z" in operands:
                return (operation, operands) == ("ldi", f"{register}, {value}")
        return False

    def restores(self, address):
        """Writes SREG, or switches interrupts on; the compiler has its address in Z at times."""
        operation, operands = self.at[address][:2]
        by_pointer = operation == "st" and operands.startswith("Z,") and self.loaded(address, "r30", SREG_MEMORY) \
            and self.loaded(address, "r31", "0x00")
        return operation in ("sei", "reti") or (operation == "out" and operands.startswith(SREG_IO)) or by_pointer

    def handler(self, name, shuns=lambda address: False):
        """Cycles from the interrupt's response over the jump in the vector table to the return."""
        number = int(name.rpartition("_")[2])
        jump = self.at[4 * number][0]
        return RESPONSE + CYCLES[jump] + self.longest(self.entry[name], self.returns, shuns)

    def touches_bus(self, address):
        return TWCR in self.at[address][1]


def judged(elf):
    """[(what, cycles, limit)] of an image."""
    code = Code(elf)
    found = [(name, f"{what} handler", code.handler(name), limit) for name, (what, limit) in HANDLERS.items()]
    busy = code.handler("__vector_1", code.touches_bus)
    found.append(("__vector_1", "data-ready handler with the bus busy", busy, latency.DATA_READY_BUSY_CYCLES))
    for address, (operation, *_, function) in code.at.items():
        if operation == "cli" and function not in NO_SECTIONS:
            found.append((function, f"interrupts off in {function}", code.longest(address, code.restores), latency.MAIN_OFF_CYCLES))
    sources = {s.name: s.source for s in symbols() if s.section.startswith(".text")}
    return [(sources.get(function.partition(".")[0], "?"), *line) for function, *line in found]


def check():
    if not sys.argv[1:]:
        raise Stop("name an ELF file")
    every = [(elf, *line) for elf in map(pathlib.Path, sys.argv[1:]) for line in judged(elf)]
    findings = [f"{where}: {what}: {cycles} cycles (campaigns/faults/latency.py: {limit}) in {elf}"
                for elf, where, what, cycles, limit in every if cycles > limit]
    if latency.CLOCK_WAITS_CYCLES > latency.LATENCY_CYCLES:
        findings.append(f"campaigns/faults/latency.py: the clock may wait {latency.CLOCK_WAITS_CYCLES} cycles (limit {latency.LATENCY_CYCLES})")
    summary = f"{len(every)} handlers and stretches in {len(sys.argv) - 1} images; the clock waits {latency.CLOCK_WAITS_CYCLES} cycles at most"
    return report("waits", findings if findings and binding() else [], summary)


if __name__ == "__main__":
    main(check)
