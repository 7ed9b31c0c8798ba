#!/usr/bin/env python3
"""demo_page.py HEX WORKER LICENCE AVR8JS_LICENCE AVR_LIBC_LICENCE OUT: the demo as one file: web/demo.html with its scripts, the image, the worker and the
licences."""
import base64
import html
import pathlib
import sys

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from tilt.whole_page import whole  # noqa: E402

MOST_BYTES = 250_000
DATA = 0  # the type of an Intel hex record; an UNO's flash needs no other but the last


def flash_of(text):
    """The bytes of an Intel hex file, from address 0."""
    flash = bytearray()
    for line in text.split():
        record = bytes.fromhex(line.removeprefix(":"))
        address, data = int.from_bytes(record[1:3], "big"), record[4:4 + record[0]]
        if record[3] == DATA:
            flash[len(flash):] = b"\xff" * (address + len(data) - len(flash))
            flash[address:address + len(data)] = data
    return bytes(flash)


def filled(page, element, text):
    """The page with an element's content, which is empty."""
    before, opening, rest = page.partition(f'id="{element}">')
    if not opening or not rest.startswith("</"):
        sys.exit(f"demo: web/demo.html has no empty element {element}")
    return before + opening + text + rest


def main():
    image, worker, ours, avr8js, avr_libc, out = map(pathlib.Path, sys.argv[1:])
    page = whole("demo.html")
    page = filled(page, "image", base64.b64encode(flash_of(image.read_text(encoding="ascii"))).decode("ascii"))
    page = filled(page, "worker", worker.read_text(encoding="utf-8").replace("</script", "<\\/script"))
    licences = (f"{name}\n\n{path.read_text(encoding='utf-8')}" for name, path in (("tilt-uno", ours), ("avr8js", avr8js), ("avr-libc", avr_libc)))
    page = filled(page, "licences", html.escape("\n".join(licences)))
    size = len(page.encode("utf-8"))
    if size > MOST_BYTES:
        sys.exit(f"demo: the page takes {size:,} of {MOST_BYTES:,} bytes")
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(page, encoding="utf-8")
    print(f"built {out}: {size:,} of {MOST_BYTES:,} bytes")


if __name__ == "__main__":
    main()
