"""The firmware's objects before link-time optimisation (build/check/avr): symbols, sections, and who calls whom."""
import functools
import pathlib
import re
from dataclasses import dataclass, field

from check_support import Stop, run

FOLDER = pathlib.Path("build/check/avr")
# a function of a law's descriptor, in the source
SLOT = re.compile(r"(?:\bLAW_OF\(\w+, |\bFLASH_FUNCTION\(&\w+->)(\w+)\)")


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


def descriptors(every):
    """{slot: set of keys}: the functions in the descriptors of the laws of lib/filters, which end with their pointers and the name."""
    header = pathlib.Path("lib/filters/src/tracker.h").read_text(encoding="utf-8")
    slots = re.findall(r"\(\*(\w+)\)\(", header.partition("struct filter_law {")[2].partition("\n};")[0])
    ends = {s.name: s.size - len(f"{s.name.removeprefix('filter_law_')}\0") for s in symbols()
            if s.name.startswith("filter_law_") and s.section != "*UND*"}
    found, law = {slot: set() for slot in slots}, None
    for path in objects():
        for line in run("avr-objdump", "-r", path).splitlines():
            if line.startswith("RELOCATION RECORDS"):
                law = next(iter(re.findall(r"\[\S*\.(filter_law_\w+)\]", line)), None)
            pointer = law and re.match(r"([0-9a-f]{8}) R_AVR_16_PM\s+(?:\.text\.)?(\w+)$", line)
            if pointer:
                own = (source_of(path), pointer.group(2))
                keys = [own] if own in every else [key for key in every if key[1] == own[1]]
                if len(keys) != 1:
                    raise Stop(f"{path}: {law}: {own[1]} is defined {len(keys)} times in the objects")
                found[slots[(int(pointer.group(1), 16) - ends[law]) // 2]].add(keys[0])
    return found


def called_slots(function):
    """Slots of a descriptor through which it calls; none: its calls through a pointer, if any, are others."""
    return slots_used(function.source).get(function.name, set()) if function.indirect else set()


@functools.cache
def slots_used(source):
    """{function: slots of a descriptor that it calls}, what the compiler may inline into it included."""
    text = pathlib.Path(source).read_text(encoding="utf-8")
    bodies = dict(re.findall(r"^\w[^;{}\n]*?\b(\w+)\([^;{}]*\)\n\{\n(.*?)^\}", text, re.M | re.S))
    used = {name: set(SLOT.findall(body)) for name, body in bodies.items()}
    for _ in bodies:
        for name, body in bodies.items():
            used[name].update(*(used[other] for other in bodies if re.search(rf"\b{other}\(", body)))
    return used


def graph():
    """(functions, {key: set of keys called, also by descriptors}, {key: set of names that no object defines})."""
    every = functions()
    law = descriptors(every)
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
        for slot in called_slots(function):
            if not law.get(slot):
                raise Stop(f"{function.source}: {function.name} calls {slot}, which no descriptor in the objects has")
            edges[key] |= law[slot]
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
