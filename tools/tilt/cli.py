"""`tilt`: finds its sub-commands in tilt.commands; turns their exceptions into one line and an exit status.

Status: 0 done, 1 done, but rows are missing, a check failed or the board refused, 2 a file, an option or the port cannot be used, 130 Ctrl-C.
"""
import argparse
import importlib
import os
import pkgutil
import sys

from tilt import commands
from tilt.errors import TiltError
from tilt.options import EXIT_UNUSABLE, Parser
from tilt.place import VERSION

EXIT_INTERRUPTED = 130


def modules():
    """The sub-commands' modules by name."""
    found = [importlib.import_module(f"{commands.__name__}.{place.name}") for place in pkgutil.iter_modules(commands.__path__)]
    return {module.NAME: module for module in sorted(found, key=lambda module: module.NAME)}


def parser_of(found):
    parser = Parser(prog="tilt", description="Work with tilt-uno recordings and boards on the PC.")
    parser.add_argument("--version", action="version", version=f"tilt {VERSION}")
    jobs = parser.add_subparsers(dest="job", metavar="COMMAND", required=True)
    for name, module in found.items():
        job = jobs.add_parser(name, help=module.SUMMARY, description=module.__doc__,
                              formatter_class=argparse.RawDescriptionHelpFormatter)
        module.arguments(job)
    return parser


def main(words=None):
    found = modules()
    args = parser_of(found).parse_args(words)
    try:
        return found[args.job].run(args) or 0
    except TiltError as error:
        print(f"tilt {args.job}: {error}", file=sys.stderr)
        return EXIT_UNUSABLE
    except KeyboardInterrupt:
        return EXIT_INTERRUPTED
    except BrokenPipeError:  # the reader has closed the pipe, as `head` does
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0


if __name__ == "__main__":
    sys.exit(main())
