"""A progress bar on the terminal for long work; nothing if the output is not a terminal."""
import contextlib
import sys


@contextlib.contextmanager
def bar(what, unit):
    """Yields report(done, whole), to be called during the work."""
    if not sys.stderr.isatty():
        yield lambda done, whole: None
        return
    from tqdm import tqdm  # slow to import
    with tqdm(desc=what, unit=unit, unit_scale=True, leave=False, delay=0.5) as shown:
        def report(done, whole):
            shown.total = whole
            shown.update(done - shown.n)
        yield report
