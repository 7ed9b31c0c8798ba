"""ADXL345 recordings on the PC: `import tilt` in Python (docs/python.md), and the command `tilt`, one sub-command per job."""
import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tilt.errors import TiltError
    from tilt.replaying import filters, parameters, replay
    from tilt.stream import Stream

ROBUST, PLAIN = "sprf", "kf"  # recordings are judged with these: one filter with a gate, one that accepts every reading

# names of the Python interface, loaded when they are first used, so that `tilt --help` is quick
OFFERED = {"Stream": "stream", "TiltError": "errors", "filters": "replaying", "parameters": "replaying", "replay": "replaying"}
__all__ = list(OFFERED)


def __getattr__(name):
    if name not in OFFERED:
        raise AttributeError(f"module 'tilt' has no attribute '{name}'")
    return getattr(importlib.import_module(f"tilt.{OFFERED[name]}"), name)


def __dir__():
    """For the completion of names in a notebook."""
    return [*globals(), *OFFERED]
