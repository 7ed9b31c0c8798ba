"""The bytes of a file: rejects what is not a recording by its first bytes; text comes in blocks of whole lines."""
import codecs
import io
import os
import sys

from tilt.errors import TiltError

BLOCK_BYTES = 8 << 20
LONG_BYTES = 8 << 20  # from this size on, progress is shown
PROBE_BYTES = 65536
PACKED = {b"\x1f\x8b": "gzip", b"PK\x03\x04": "zip (or a spreadsheet)", b"BZh": "bzip2", b"\xfd7zXZ\x00": "xz",
          b"7z\xbc\xaf\x27\x1c": "7-zip", b"\x28\xb5\x2f\xfd": "zstandard", b"Rar!": "rar"}
STRANGE = {b"%PDF": "a PDF", b"\x89PNG": "a picture", b"\xff\xd8\xff": "a picture", b"\x7fELF": "a program", b"\x89HDF": "an HDF5 file",
           b"SQLite format 3": "a database", b"RIFF": "a sound or video file", b"PAR1": "a Parquet file"}
WIDE_MARKS = {codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}  # what PowerShell's > writes


def progress(total, path, words):
    """A bar on stderr, for long work at a terminal."""
    from tqdm import tqdm
    return tqdm(total=total, unit="B", unit_scale=True, desc=f"{words} {os.path.basename(path)}", leave=False,
                disable=total < LONG_BYTES or not sys.stderr.isatty())


def begin(path):
    """The first bytes of a file. TiltError if it cannot be a recording."""
    try:
        with open(path, "rb") as file:
            head = file.read(PROBE_BYTES)
    except OSError as why:
        raise TiltError(f"{path}: {why.strerror}: give a recording's path") from None
    if not head:
        raise TiltError(f"{path}: the file is empty: record again")
    for marks, words in ((PACKED, "packed with {}: unpack it first"), (STRANGE, "this is {}, not a recording: export the readings as CSV")):
        for mark, name in marks.items():
            if head.startswith(mark):
                raise TiltError(f"{path}: {words.format(name)}")
    return head


def is_cwa(head):
    return head[:2] == b"MD" and len(head) >= 4 and head[2:4] == b"\xfc\x03"


def as_text(path, file, head):
    """The file, in UTF-8 without a byte order mark. TiltError if it is not text."""
    for mark, encoding in WIDE_MARKS.items():
        if head.startswith(mark):
            try:
                return io.BytesIO(file.read().decode(encoding).encode("utf-8"))
            except UnicodeDecodeError as why:
                raise TiltError(f"{path}: begins as UTF-16, but is not valid at byte {why.start}: save it as UTF-8") from None
    strange = sum(byte < 32 and byte not in b"\t\n\r\f" for byte in head[:4096])
    if b"\0" in head or strange > len(head[:4096]) // 10:
        raise TiltError(f"{path}: binary data in an unknown format (known: text, JSON, the AX3's CWA): export the readings as CSV")
    if head.startswith(codecs.BOM_UTF8):
        file.seek(len(codecs.BOM_UTF8))
    return file


def blocks(path, file, head):
    """(number of the first line, bytes of whole lines); lines end with LF or, in a file without LF, with CR."""
    end = b"\n" if b"\n" in head or b"\r" not in head else b"\r"
    line, rest = 1, b""
    with progress(os.path.getsize(path), path, "read") as bar:
        while True:
            data = file.read(BLOCK_BYTES)
            bar.update(len(data))
            block, cut, after = (rest + data).rpartition(end) if data else (rest, b"", b"")
            whole = block + cut
            rest = after
            if whole:
                whole = whole.replace(b"\r", b"\n") if end == b"\r" else whole
                yield line, whole
                line += whole.count(b"\n")
            if not data:
                return
