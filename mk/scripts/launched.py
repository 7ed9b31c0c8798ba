"""What `python FOLDER` and `python -m PACKAGE` begin with: the folder's command, or one line about the package that it lacks."""
import importlib
import pathlib
import sys


def run(folder, module, packages):
    """Exits with the status of the module's main; `packages` is what tools/deps.sh calls those that the folder wants."""
    name = pathlib.PurePath(folder).name
    try:
        main = importlib.import_module(f"{name}.{module}").main
    except ImportError as problem:
        sys.exit(f"{name}: {problem.name or problem} is not installed for {sys.executable}: "
                 f"sh tools/deps.sh {packages}, then build/venv/bin/python {folder}")
    sys.exit(main(sys.argv[1:]))
