"""The start of `python FOLDER` and `python -m PACKAGE`: the folder's command, or one line about a missing package."""
import importlib
import pathlib
import sys


def run(folder, module, packages):
    """Exits with the status of the module's main; `packages` is the group of tools/deps.sh that the folder needs."""
    name = pathlib.PurePath(folder).name
    try:
        main = importlib.import_module(f"{name}.{module}").main
    except ImportError as problem:
        sys.exit(f"{name}: {problem.name or problem} is not installed for {sys.executable}: "
                 f"sh tools/deps.sh {packages}, then build/venv/bin/python {folder}")
    sys.exit(main(sys.argv[1:]))
