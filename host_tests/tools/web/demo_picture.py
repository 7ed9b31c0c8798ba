#!/usr/bin/env python3
"""docs/demo.png and docs/demo-phone.png: the demo among outliers, with SDA at ground for a moment, on a desktop and as a phone shows it
(make pictures). Run from the repository root."""
import pathlib
import sys

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from browser import Browser  # noqa: E402
from demo_support import PAGE, WHY_NOT  # noqa: E402

PICTURES = {"docs/demo.png": ((1280, 900), "light"), "docs/demo-phone.png": ((360, 640), "dark")}
HELD_S, ROWS_AFTER = 0.4, 250


def taken(browser, size, theme, path):
    page = browser.open("about:blank", size=size)
    page.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": theme}])
    page.call("Page.navigate", url=PAGE.resolve().as_uri())
    page.until("tiltPage.figures().rows >= 600")
    begun_s = page.value("document.querySelector('[data-hold=sda]').click(), tiltPage.history.last")
    page.until(f"tiltPage.figures().fault && tiltPage.history.last > {begun_s + HELD_S}")
    rows = page.value("document.querySelector('[data-hold=sda]').click(), tiltPage.figures().rows")
    page.until(f"!tiltPage.figures().fault && tiltPage.figures().rows > {rows + ROWS_AFTER}")
    page.picture(path)
    print(f"{path} written")


def main():
    if WHY_NOT:
        sys.exit(f"demo_picture: {WHY_NOT}")
    with Browser() as browser:
        for path, (size, theme) in PICTURES.items():
            taken(browser, size, theme, path)


if __name__ == "__main__":
    main()
