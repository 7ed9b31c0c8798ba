"""python tools/design ..., from any folder."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from launched import run  # noqa: E402

if __name__ == "__main__":
    run("design", "command", "design")
