"""What all programs share that write a page: their end, and that no title stands twice."""
import subprocess
import sys

from page_sources import Fault


def run_as_program(name, main):
    """Ends the program with main's status; 2 and one sentence where it cannot do its work."""
    try:
        sys.exit(main())
    except (Fault, OSError, subprocess.TimeoutExpired) as problem:
        print(f"{name}: {problem}", file=sys.stderr)
        sys.exit(2)


def no_title_twice(document, lines):
    """Refuses tables of one title: a number is known by the title that it stands under, so one of them would be lost."""
    titles = [line.lstrip("# ") for line in "\n".join(lines).splitlines() if line.startswith("#")]
    for title in titles:
        if titles.count(title) > 1:
            raise Fault(f"{document}: the title '{title}' occurs {titles.count(title)} times")
