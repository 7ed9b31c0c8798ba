"""What has been proved already: host_tests/proof/proved.json, one line a proof with the hash of all it is made of.

A proof whose files, Frama-C and options are those of its line needs no second run; `make proof` runs every one and writes the lines.
"""
import hashlib
import json
import pathlib
import re

LEDGER = pathlib.Path("host_tests/proof/proved.json")
PLAIN_COMMENT = re.compile(r"/\*(?!@).*?\*/|//(?!@)[^\n]*", re.S)


def digest(files, options):
    """Hash of these sources and options. Comments of the product count only where Frama-C reads them; those of proofs are options too."""
    text = [*options]
    for path in sorted(files):
        code = path.read_text(encoding="utf-8")
        text += [path.name, " ".join((code if path.parent == LEDGER.parent else PLAIN_COMMENT.sub(" ", code)).split())]
    return hashlib.sha256("\n".join(text).encode()).hexdigest()[:16]


def read():
    """file -> (digest, functions reached, wraps met), as of the last run that passed."""
    if not LEDGER.exists():
        return {}
    rows = json.loads(LEDGER.read_text(encoding="utf-8"))
    return {file: (row["inputs"], set(row["reached"]), {tuple(wrap) for wrap in row["wraps"]}) for file, row in rows.items()}


def write(rows):
    lines = [f"{json.dumps(file)}: " + json.dumps({"inputs": inputs, "reached": sorted(reached), "wraps": sorted(wraps)})
             for file, (inputs, reached, wraps) in sorted(rows.items())]
    LEDGER.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
