"""A bar on the terminal for work that takes long; nothing where nobody looks."""
import contextlib
import sys


@contextlib.contextmanager
def bar(what, unit):
    """told(done, whole) to be called as the work goes on."""
    if not sys.stderr.isatty():
        yield lambda done, whole: None
        return
    from tqdm import tqdm  # takes long to import
    with tqdm(desc=what, unit=unit, unit_scale=True, leave=False, delay=0.5) as shown:
        def told(done, whole):
            shown.total = whole
            shown.update(done - shown.n)
        yield told
