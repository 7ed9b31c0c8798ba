"""python campaigns/synthesis 000|001 --list | EXPERIMENT [--runs N] [--seed N]: the experiments of papers 000 and 001, from any folder."""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / folder) for folder in (ROOT / "mk/pythonpath").read_text(encoding="ascii").split()]
from launched import run  # noqa: E402

if __name__ == "__main__":
    run("campaigns/synthesis", "program", "papers")
