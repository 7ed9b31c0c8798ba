"""A failed test of a Python program, in the form of Unity's reports: the name and the reason on one line, what else there is to know on
lines after it, which campaigns/tests/run_tests.py repeats above its closing line."""
import pathlib
import traceback

MORE = "  | "  # begins each further line of a reason
HEAD, TAIL = 4, 16  # lines that are kept of a long one


def failure(file, name, reason):
    """The text to print; `reason` may have any number of lines, of which a long one loses its middle."""
    first, *more = [line.rstrip() for line in reason.strip().splitlines() if line.strip()] or ["no reason given"]
    if len(more) > HEAD + TAIL:
        more = [*more[:HEAD], f"... {len(more) - HEAD - TAIL} lines left out ...", *more[-TAIL:]]
    return "\n".join([f"{file}:{name}:FAIL: {first[:600]}", *(f"{MORE}{line[:600]}" for line in more)])


def reason_of(problem):
    """An exception in words: its message, the assertion itself where it has none, the words of a program that it is about, the place."""
    frames = traceback.extract_tb(problem.__traceback__)
    own = frames[1 if len(frames) > 1 else 0].filename  # the test's own file: whoever calls it has caught the exception
    frame = [each for each in frames if each.filename == own][-1]
    words = [str(problem) or f"{type(problem).__name__}: {frames[-1].line}"]
    for stream in ("stderr", "stdout"):
        said = getattr(problem, stream, None) or ""
        words.append(said.decode("utf-8", "replace") if isinstance(said, bytes) else said)
    return "\n".join([*words, f"at {pathlib.Path(frame.filename).name}:{frame.lineno}"])


def reason_in(trace):
    """The same of a traceback that is text already, as unittest keeps it."""
    lines = trace.rstrip().splitlines()
    places = [number for number, line in enumerate(lines) if line.startswith("  File ")]
    after = places[-1] + 1 if places else 0
    begin = next((number for number in range(after, len(lines)) if lines[number][:1].strip()), 0)
    return "\n".join([*lines[begin:], *([f"at {lines[places[-1]].strip()}"] if places else [])])
