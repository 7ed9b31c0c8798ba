"""The firmware's objects before link-time optimisation (build/check/avr): symbols, sections, and who calls whom."""
import pathlib
import re
from dataclasses import dataclass, field

from check_support import Stop, run

FOLDER = pathlib.Path("build/check/avr")


@dataclass
class Function:
    source: str
    name: str
    calls: set = field(default_factory=set)  # names as the assembler wrote them
    indirect: bool = False


def objects():
    found = sorted(FOLDER.rglob("*.o"))
    if not found:
        raise Stop(f"no objects in {FOLDER}: run the check by make")
    return found


def source_of(path):
    return str(path.relative_to(FOLDER).with_suffix(".c"))


@dataclass
class Symbol:
    source: str
    section: str
    value: int
    size: int
    name: str
    is_global: bool


def symbols():
    """All symbols of all objects; section *UND* for those wanted from elsewhere."""
    for path in objects():
        for line in run("avr-objdump", "-t", path).splitlines():
            found = re.match(r"([0-9a-f]{8}) (.{7}) (\S+)\t([0-9a-f]{8}) (?:\.hidden )?(.+)$", line)
            if found:
                value, flags, section, size, name = found.groups()
                yield Symbol(source_of(path), section, int(value, 16), int(size, 16), name, "l" not in flags)


def sections():
    """(source, section, size, whether it holds anything) of all objects."""
    for path in objects():
        for line in run("avr-objdump", "-h", path).splitlines():
            found = re.match(r"\s*\d+ (\S+)\s+([0-9a-f]{8}) ", line)
            if found:
                yield source_of(path), found.group(1), int(found.group(2), 16)


def functions():
    """{(source, name): Function} with every call, jump and taken address of another function."""
    found = {}
    for path in objects():
        current, instruction = None, ""
        for line in run("avr-objdump", "-dr", path).splitlines():
            title = re.match(r"[0-9a-f]{8} <([^>]+)>:$", line)
            if title:
                current = Function(source_of(path), title.group(1))
                found[current.source, current.name] = current
            elif current and "R_AVR_" in line:
                note_call(current, instruction, line)
            elif current:
                instruction = line
                current.indirect = current.indirect or bool(re.search(r"\t(e?icall|e?ijmp)\b", line))
    return found


def note_call(function, instruction, line):
    """Relocations name the targets; inside the function itself only a call to its start is one."""
    relocation = re.search(r"R_AVR_(?:CALL|13_PCREL|7_PCREL|LO8_LDI_GS|16_PM)\s+(\S+?)([+-]0x[0-9a-f]+)?$", line)
    if relocation:
        target = re.sub(r"^\.text\.", "", relocation.group(1))
        calls_itself = relocation.group(2) is None and re.search(r"\tr?call\b", instruction)
        if target != function.name or calls_itself:
            function.calls.add(target)


def graph():
    """(functions, {key: set of keys called}, {key: set of names that no object defines})."""
    every = functions()
    by_name = {}
    for source, name in every:
        by_name.setdefault(name, []).append((source, name))
    edges, outside = {}, {}
    for key, function in every.items():
        edges[key], outside[key] = set(), set()
        for name in function.calls:
            own = (function.source, name)
            if own in every:
                edges[key].add(own)
            elif len(by_name.get(name, [])) == 1:
                edges[key].add(by_name[name][0])
            else:
                outside[key].add(name)
    return every, edges, outside


def reach(edges, start):
    """{key: key that called it} of everything that start leads to, itself included."""
    caller, todo = {start: None}, [start]
    while todo:
        at = todo.pop()
        for target in sorted(edges[at]):
            if target not in caller:
                caller[target] = at
                todo.append(target)
    return caller


def chain(caller, key):
    """How the key is reached, as words."""
    names = []
    while key is not None:
        names.append(key[1])
        key = caller[key]
    return " -> ".join(reversed(names))
