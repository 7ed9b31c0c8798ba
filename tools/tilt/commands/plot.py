"""Draws recordings: raw against filtered roll and pitch, the gated readings, the flags, the truth if the file has it, and the spectrum.

Reads what the firmware sent (tilt record), what tilt replay wrote, and plain streams (t_us,x,y,z). Several files are drawn over each other, or
with --stack one below the other. The suffix of -o decides: .png and .svg are pictures, .html is one self-contained page for any browser,
with zoom, drag and the numbers under the pointer.
"""
import pathlib
import sys

from tilt.errors import TiltError
from tilt.numbers import real_option

NAME = "plot"
SUMMARY = "draw recordings: raw against filtered, flags, spectrum"
SUFFIXES = ("png", "svg", "html")
KINDS = ("roll", "pitch", "x", "y", "z", "flags", "spectrum")
USUAL = ("roll", "pitch", "flags", "spectrum")
BIG_BYTES = 8 << 20  # from this size on, reading shows progress


def arguments(parser):
    parser.add_argument("files", nargs="+", metavar="FILE", help="recordings or streams")
    parser.add_argument("-o", "--output", metavar="OUT", help="OUT.png, OUT.svg or OUT.html (default: the first FILE with .png, here)")
    parser.add_argument("--columns", metavar="LIST", default=",".join(USUAL), help=f"comma-separated, of {' '.join(KINDS)} (default: %(default)s)")
    parser.add_argument("--from", dest="from_s", type=real_option, metavar="S", help="begin S seconds after the start of each file")
    parser.add_argument("--to", dest="to_s", type=real_option, metavar="S", help="end S seconds after the start of each file")
    parser.add_argument("--stack", action="store_true", help="draw files one below the other")
    parser.add_argument("--title", help="title (default: the files' names)")


def kinds_of(text):
    kinds = [word.strip() for word in text.split(",") if word.strip()]
    for kind in kinds:
        if kind not in KINDS:
            raise TiltError(f"--columns: no column {kind}: choose from {' '.join(KINDS)}")
    if not kinds:
        raise TiltError("--columns: empty: name at least one")
    return [kind for kind in KINDS if kind in kinds]


def output_of(args):
    path = pathlib.Path(args.output or pathlib.Path(args.files[0]).with_suffix(".png").name)
    suffix = path.suffix[1:].lower()
    if suffix not in SUFFIXES:
        raise TiltError(f"{path}: unknown suffix: use one of .{' .'.join(SUFFIXES)}")
    return path, suffix


def progress_of(path):
    """A progress bar for a large file, on a terminal."""
    if not sys.stderr.isatty() or not pathlib.Path(path).is_file() or pathlib.Path(path).stat().st_size < BIG_BYTES:
        return None
    from tqdm import tqdm
    bar = tqdm(total=1.0, desc=f"reading {path}", bar_format="{desc}: {percentage:3.0f}% {bar}", leave=False)
    return lambda done, whole: bar.update(done / whole - bar.n)


def run(args):
    path, suffix = output_of(args)
    kinds = kinds_of(args.columns)
    from tilt import pictured
    files = [one for name in args.files for one in pictured.load(name, args.from_s, args.to_s, progress_of(name))]
    title = args.title or ", ".join(pathlib.Path(name).name for name in args.files)
    if suffix == "html":
        from tilt import plot_page
        plot_page.write(path, files, kinds, not args.stack, title)
    else:
        from tilt import picture
        picture.write(path, suffix, files, kinds, not args.stack, title)
    for one in files:
        print(f"{one.name}: {len(one):,} rows, {one.t_s[-1] - one.t_s[0]:.1f} s at {one.rate_hz:.4g} Hz, gated {int(one.gated.sum()):,}, "
              f"without a sample {int(one.missing.sum()):,}")
    print(f"{'page' if suffix == 'html' else 'picture'}: {path}")
