"""python tools/variable_structure --list | EXPERIMENT [--runs N] [--seed N]: the experiments of paper 004, from any folder."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
try:
    from variable_structure.program import main
except ImportError as problem:
    sys.exit(f"variable_structure: {problem.name or problem} is not installed for {sys.executable}: "
             "sh tools/deps.sh papers, then build/venv/bin/python tools/variable_structure")

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
