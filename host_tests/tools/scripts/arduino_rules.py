"""What the Arduino library specification (docs.arduino.cc/arduino-cli/library-specification) and PlatformIO's library.json ask of a folder.

findings(folder) -> a sentence for each breach, with file and line. Written from the specification's words; part of test_arduino.py.
`python3 host_tests/tools/scripts/arduino_rules.py build/library/tilt-filters lib/filters`, which `make arduino` runs, writes lib/filters/keywords.txt
from the headers where it differs.
"""
import json
import pathlib
import re
import sys

REQUIRED = ("name", "version", "author", "maintainer", "sentence", "paragraph", "category", "url", "architectures", "includes")
CATEGORIES = ("Display", "Communication", "Signal Input/Output", "Sensors", "Device Control", "Timing", "Data Storage", "Data Processing", "Other")
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9 _.\-]{0,62}")
FOLDER = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.\-]{0,62}")
VERSION = re.compile(r"(0|[1-9]\d*)\.(0|[1-9]\d*)\.(0|[1-9]\d*)(-[0-9A-Za-z.-]+)?")
KEYWORDS = ("KEYWORD1", "KEYWORD2", "KEYWORD3", "LITERAL1", "LITERAL2")
# of each header that a sketch may include
COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.S)
FUNCTION = re.compile(r"^(?:static inline )?(?!typedef|static|extern|#|return)[\w ]+[ *](\w+)\([^;{]*\)(?:;|\n\{)", re.M)
TYPE = re.compile(r"^\}\s*(\w+);|^typedef \w+ (\w+);", re.M)
LITERAL = re.compile(r"^\s+((?:FILTER|TILT)_[A-Z_]+)\s*(?:=|,)"
                     r"|(?<=[{ ])([A-Z]\w*_(?:UQ|Q|LSB|MS|SAMPLES|K|VARIANT_U|IDENTIFY)[A-Z0-9_]*)(?=,|\s*\})", re.M)


def findings(folder):
    folder = pathlib.Path(folder)
    return [*properties_findings(folder), *library_json_findings(folder), *keywords_findings(folder), *layout_findings(folder)]


def properties(path):
    """{field: (line, value)}, and what is no property."""
    fields, said = {}, []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        key, equals, value = line.partition("=")
        if not line.strip() or line.startswith("#"):
            continue
        if not equals:
            said.append(f"{path}:{number}: no '=' in '{line}'")
        elif key in fields:
            said.append(f"{path}:{number}: {key} a second time")
        else:
            fields[key] = number, value.strip()
    return fields, said


def properties_findings(folder):
    path = folder / "library.properties"
    if not path.is_file():
        return [f"{path}: is not there"]
    fields, said = properties(path)
    said += [f"{path}: no field {name}" for name in REQUIRED if name not in fields]
    rules = {
        "name": lambda v: NAME.fullmatch(v) and not v.lower().startswith("arduino") and any(c.isalpha() for c in v),
        "version": VERSION.fullmatch,
        "category": lambda v: v in CATEGORIES,
        "url": lambda v: re.fullmatch(r"https?://[\w.-]+(/\S*)?", v),
        "architectures": lambda v: re.fullmatch(r"\*|\w+(,\w+)*", v),
        "includes": lambda v: all((folder / "src" / name.strip()).is_file() for name in v.split(",")),
        "paragraph": lambda v: v and fields.get("sentence", (0, None))[1] not in v,
    }
    return said + [f"{path}:{number}: {name} may not be '{value}'" for name, (number, value) in fields.items()
                   if name in REQUIRED and (not value or not rules.get(name, bool)(value))]


def library_json_findings(folder):
    path = folder / "library.json"
    try:
        manifest = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as why:
        return [f"{path}: {why}"]
    fields, _ = properties(folder / "library.properties") if (folder / "library.properties").is_file() else ({}, [])
    said = [f"{path}: {name} is '{manifest.get(name)}', in library.properties '{fields[name][1]}'" for name in ("name", "version")
            if name in fields and manifest.get(name) != fields[name][1]]
    return said + [f"{path}: there is no header {name}" for name in manifest.get("headers", []) if not (folder / "src" / name).is_file()]


def public_names(folder):
    """{name: kind of keyword} of what the headers of library.json declare."""
    names = {}
    for header in [*json.loads((folder / "library.json").read_text(encoding="utf-8"))["headers"], "filter.h"]:
        text = COMMENT.sub("", (folder / "src" / header).read_text(encoding="utf-8"))
        for pattern, kind in ((FUNCTION, "KEYWORD2"), (TYPE, "KEYWORD1"), (LITERAL, "LITERAL1")):
            names |= {name: kind for match in pattern.finditer(text) for name in match.groups() if name}
        names |= {f"filter_law_{name}": "LITERAL1" for name in re.findall(r"\bX\((\w+)\)", text)}  # declared by the list FILTER_LAWS
    state = (folder / "src" / "filter_state.h").read_text(encoding="utf-8")  # its other types are inside
    return names | {name: "KEYWORD1" for name in re.findall(r"\b(filter_t|filter_law_t);", COMMENT.sub("", state))}


def keywords_findings(folder):
    """One tab between word and kind; the words are what the headers declare."""
    path = folder / "keywords.txt"
    if not path.is_file():
        return [f"{path}: is not there"]
    said, found = [], {}
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        word, _, kind = line.partition("\t")
        if not re.fullmatch(r"\w+", word) or kind not in KEYWORDS:
            said.append(f"{path}:{number}: '{line}' is no word, tab and one of {' '.join(KEYWORDS)}")
        found[word] = number, kind
    names = public_names(folder)
    said += [f"{path}:{number}: no header declares {word} as {kind}" for word, (number, kind) in found.items() if names.get(word) != kind]
    return said + [f"{path}: {name} is missing: make arduino writes it" for name in names if name not in found]


def layout_findings(folder):
    said = [] if FOLDER.fullmatch(folder.name) else [f"{folder}: no name for a folder of a library"]
    said += [f"{path}: not in a library" for path in folder.rglob("*") if path.is_symlink() or path.suffix == ".exe" or path.name == ".development"]
    said += [f"{folder / name}: is not there" for name in ("README.md", "LICENSE") if not (folder / name).is_file()]
    sketches = list((folder / "examples").glob("*")) if (folder / "examples").is_dir() else []
    said += [f"{sketch}: no sketch {sketch.name}.ino" for sketch in sketches if not (sketch / f"{sketch.name}.ino").is_file()]
    return said + ([] if sketches else [f"{folder}/examples: no sketch"])


def write_keywords(library, folder):
    names = public_names(library)
    lines = [f"{name}\t{kind}\n" for kind in KEYWORDS for name in names if names[name] == kind]
    path = folder / "keywords.txt"
    if path.read_text(encoding="utf-8") != "".join(lines):
        path.write_text("".join(lines), encoding="utf-8")


if __name__ == "__main__":
    write_keywords(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
