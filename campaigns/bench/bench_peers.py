"""make bench, beside other people's filters: what theirs and ours cost on the simulated chip and how far from the truth they are, on one stream,
built with the same flags. Theirs lie outside of this repository (PEERS=folder); where one is absent it is skipped and counted."""
import concurrent.futures
import csv
import math
import pathlib
import statistics
import struct
from typing import NamedTuple

import laws
from bench_firmware import OUT, Fault, image_size, printed, run
from results import markdown

FOLDER = OUT / "bench_peers"
STREAM = pathlib.Path("sim/streams/outliers-15pct.csv")
X_LSB_PER_G = 265  # of the stream, as its head says
SETTLED = 100      # samples before any number is taken
CORES = 2
ADAPTERS = pathlib.Path("host_tests/chip")
# the Arduino core's options for C++
CXX = ["-std=gnu++11", "-fno-exceptions", "-fno-threadsafe-statics"]
KINDS = {"f": lambda bits: struct.unpack("<f", struct.pack("<I", bits))[0],
         "q": lambda bits: struct.unpack("<i", struct.pack("<I", bits))[0] / 65536,
         "i": lambda bits: struct.unpack("<h", struct.pack("<H", bits & 0xFFFF))[0]}


class Subject(NamedTuple):
    """A filter of the table: its name, what it is, its adapter, folders and further sources within PEERS, options of the compiler."""
    name: str
    words: str
    adapter: str
    folders: tuple = ()
    sources: tuple = ()
    options: tuple = ()

    @property
    def libraries(self):
        return sorted({folder.split("/")[0] for folder in self.folders})

    @property
    def label(self):
        return self.name if self.folders else f"`{self.name}`"


FIX16 = ("libfixkalman", "libfixmatrix", "libfixmath/libfixmath")
FIX16_SOURCES = ("libfixkalman/fixkalman.c", "libfixmatrix/fixmatrix.c", "libfixmatrix/fixarray.c", "libfixmath/libfixmath/fix16.c",
                 "libfixmath/libfixmath/fix16_sqrt.c")
# avr-gcc 5.4.0 translates it wrongly with its defaults
FIX16_FASTEST = ("-DFIXMATRIX_MAX_SIZE=2", "-DFIXMATH_OPTIMIZE_8BIT", "-DFIXMATH_NO_OVERFLOW", "-DFIXMATH_NO_ROUNDING")
NOTHING = Subject("nothing", "", "peer_nothing.c")
THEIRS = (
    Subject("SimpleKalmanFilter", "float, position", "peers/simple_kalman_filter.cpp", ("SimpleKalmanFilter/src",),
            ("SimpleKalmanFilter/src/SimpleKalmanFilter.cpp",)),
    Subject("GyverFilters GKalman", "float, position", "peers/gyver_kalman.cpp", ("GyverFilters/src",)),
    Subject("GyverFilters GABfilter", "float, position and rate, constant gains", "peers/gyver_alpha_beta.cpp", ("GyverFilters/src",)),
    Subject("GyverFilters GMedian", "integer, median of ten, whole LSB", "peers/gyver_median.cpp", ("GyverFilters/src",)),
    Subject("TKJ KalmanFilter", "float, position and rate", "peers/tkj_kalman.cpp", ("TKJElectronics-KalmanFilter",),
            ("TKJElectronics-KalmanFilter/Kalman.cpp",)),
    Subject("TinyEKF", "float, position and rate, matrices", "peers/tiny_ekf.c", ("TinyEKF/src",)),
    Subject("rfetick Kalman", "float, position and rate, matrices", "peers/rfetick_kalman.cpp", ("rfetick-Kalman", "BasicLinearAlgebra")),
    Subject("libfixkalman", "Q16.16, position and rate, matrices", "peers/lib_fix_kalman.c", FIX16, FIX16_SOURCES, FIX16_FASTEST),
)


def ours():
    """The default, one with a gate, one without, the lightest; and the yardstick of the one without."""
    gated = {name: ", gate" if "GATED" in laws.laws()[name].traits else "" for name in laws.names()}
    found = [Subject(name, f"ours, fixed point, position and rate{gated[name]}", "peer_law.c", options=(f"-DPEER_LAW=filter_law_{name}",))
             for name in dict.fromkeys((laws.DEFAULT, laws.ROBUST, laws.PLAIN, laws.LIGHT))]
    return [*found, Subject(f"float_{laws.PLAIN}", "ours, float by hand, position and rate", f"peer_float_{laws.PLAIN}.c")]


def present(peers):
    """(subjects whose libraries are there, the others)."""
    absent = [subject for subject in THEIRS if not all((peers / folder).is_dir() for folder in subject.folders)]
    return [subject for subject in THEIRS if subject not in absent], absent


def said_of(absent, peers):
    """The line that counts them; nothing where all are there."""
    if not absent:
        return []
    missing = sorted({library for subject in absent for library in subject.libraries if not (peers / library).is_dir()})
    reason = f"{peers} has no {', '.join(missing)}" if peers.is_dir() else f"no folder {peers} (PEERS=folder)"
    return [f"skipped: {len(absent)} ({', '.join(subject.name for subject in absent)}: {reason}; the table beside them is left as it is)"]


# --- the images ---

def write_stream():
    """The x axis as a source for the chip; what it is in truth, and as it was read."""
    with open(STREAM, encoding="ascii") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    read = [int(row["x_lsb"]) for row in rows]
    source = FOLDER / "stream.c"
    source.write_text("#include <avr/pgmspace.h>\n#include <stdint.h>\n"
                      "extern const int16_t peer_stream[];\nextern const uint16_t peer_stream_count;\n"
                      f"const uint16_t peer_stream_count = {len(read)};\nconst int16_t peer_stream[] PROGMEM = {{ {', '.join(map(str, read))} }};\n",
                      encoding="ascii")
    return [-X_LSB_PER_G * math.sin(math.radians(int(row["pitch_true_cdeg"]) / 100)) for row in rows], read


def compiled(source, flags, folder, *options):
    """The object of a source, C or C++ by its name."""
    source, plain = pathlib.Path(source), [flag for flag in flags if not flag.startswith("-std=")]
    folder.mkdir(parents=True, exist_ok=True)
    to = folder / f"{source.stem}.o"
    compiler = ["avr-g++", *CXX] if source.suffix == ".cpp" else ["avr-gcc", "-std=gnu11"]
    run([*compiler, *plain, "-Os", *options, "-c", source, "-o", to])
    return to


def build(subject, flags, own_objects, peers):
    """Its image. Of theirs the folders come first, ours are not searched, and no warning is asked for."""
    folder = FOLDER / subject.name.replace(" ", "_")
    options = list(subject.options)
    if subject.folders:
        flags = [flag for flag in flags if not flag.startswith("-I")]
        options += ["-w", *(f"-I{peers / name}" for name in subject.folders), f"-I{ADAPTERS / 'peers'}", f"-I{ADAPTERS}"]
    try:
        objects = [compiled(source, flags, folder, *options) for source in (ADAPTERS / subject.adapter, *(peers / name for name in subject.sources))]
        image = folder / "image.elf"
        run(["avr-gcc", *flags, "-Os", *objects, *own_objects, "-lm", "-o", image])
    except Fault as problem:
        lines = str(problem).splitlines()
        raise Fault(f"{subject.name}: does not build: {next((line for line in lines if 'error' in line), lines[0])}") from None
    return image


# --- the numbers ---

def parse(text, name, count):
    """[(cycles, estimate in LSB)] of what peer_run.c prints."""
    lines = text.split()
    if len(lines) != count + 2 or lines[-1] != "=end" or lines[0][1:] not in KINDS:
        raise Fault(f"{name}: {len(lines) - 2} of {count} samples: its program did not run to its end")
    value = KINDS[lines[0][1:]]
    pairs = [(int(line[:4], 16), value(int(line[4:], 16))) for line in lines[1:-1]]
    if any(cycles == 0xFFFF for cycles, _ in pairs):
        raise Fault(f"{name}: a call takes more cycles than the timer counts")
    return pairs


def error(estimates, truth):
    """LSB rms."""
    return math.sqrt(statistics.fmean((x - t) ** 2 for x, t in zip(estimates[SETTLED:], truth[SETTLED:])))


def row_of(pairs, truth):
    cycles = [cycles for cycles, _ in pairs[SETTLED:]]
    return {"min": min(cycles), "median": round(statistics.median(cycles)), "worst": max(cycles), "error": error([x for _, x in pairs], truth)}


def simulated(subject, image, truth):
    return row_of(parse(printed(image), subject.name, len(truth)), truth)


def measure(flags, sources, peers):
    """({name: row} of ours, of theirs that are there, and of the samples themselves; those of theirs that are not there)."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    truth, read = write_stream()
    theirs, absent = present(peers)
    subjects = [NOTHING, *ours(), *theirs]
    with concurrent.futures.ThreadPoolExecutor(CORES) as workers:
        own = [ADAPTERS / "peer_run.c", FOLDER / "stream.c", *sources]
        objects = list(workers.map(lambda source: compiled(source, flags, FOLDER / "own"), own))
        harness, library = objects[:2], objects[2:]
        images = list(workers.map(lambda subject: build(subject, flags, harness + (library if subject not in theirs else []), peers), subjects))
        rows = list(workers.map(simulated, subjects[1:], images[1:], [truth] * len(images[1:])))
    empty, *sizes = map(image_size, images)
    for subject, row, size in zip(subjects[1:], rows, sizes):
        row.update(label=subject.label, words=subject.words, flash=size[0] - empty[0], ram=size[1] - empty[1])
    named = {subject.name: row for subject, row in zip(subjects[1:], rows)}
    return {**named, "no filter": {"label": "no filter", "words": "the samples as they are read", "error": error(read, truth)}}, absent


def table(rows):
    """Markdown lines, the best error first."""
    keys = ("min", "median", "worst", "flash", "ram")
    return markdown(["filter", "what it is", *keys[:4], "RAM", "error, LSB rms"],
                    [[row["label"], row["words"], *(row.get(key) for key in keys), f"{row['error']:.2f}"]
                     for row in sorted(rows.values(), key=lambda row: row["error"])])


def json_rows(rows):
    """For build/bench.json, apart from the filters' own rows by the first part of the name."""
    return [{"name": f"peers/{name}", "cycles_min": row.get("min"), "cycles_median": row.get("median"), "cycles_max": row.get("worst"),
             "flash_bytes": row.get("flash"), "ram_bytes": row.get("ram"), "stack_bytes": None, "error_lsb_rms": round(row["error"], 3)}
            for name, row in rows.items()]
