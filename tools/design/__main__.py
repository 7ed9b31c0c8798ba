"""python tools/design ..., from any folder."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
try:
    from design.command import main
except ImportError as problem:
    sys.exit(f"design: {problem.name or problem} is not installed for {sys.executable}: "
             "sh tools/deps.sh design, then build/venv/bin/python tools/design")

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
