"""What `python tools/FOLDER` and `python -m FOLDER` begin with: the folder's command, or one line about the package that it lacks."""
import importlib
import sys


def run(folder, module, packages):
    """Exits with the status of FOLDER.MODULE.main; `packages` is what tools/deps.sh calls those that the folder wants."""
    try:
        main = importlib.import_module(f"{folder}.{module}").main
    except ImportError as problem:
        sys.exit(f"{folder}: {problem.name or problem} is not installed for {sys.executable}: "
                 f"sh tools/deps.sh {packages}, then build/venv/bin/python tools/{folder}")
    sys.exit(main(sys.argv[1:]))
