"""A page of web/ as one file, with the style sheet and the scripts that it names inside."""
import pathlib
import re

HERE = pathlib.Path(__file__).resolve()
# beside this file in a wheel, at the top of a checkout
WEB = HERE.with_name("web") if HERE.with_name("web").is_dir() else HERE.parents[2] / "web"
PARTS = (('<link rel="stylesheet" href="{}">', "style"), ('<script src="{}"></script>', "script"))


def whole(page):
    """The text of web/`page`."""
    text = (WEB / page).read_text(encoding="utf-8")
    for named, tag in PARTS:
        for name in re.findall(named.format(r"([\w.]+)"), text):
            inside = (WEB / name).read_text(encoding="utf-8")
            text = text.replace(named.format(name), f"<{tag}>\n{inside}</{tag}>")
    return text
