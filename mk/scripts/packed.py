"""Archives whose bytes depend on names, contents and one time alone: not on the files' times, owners, modes or order."""
import gzip
import io
import pathlib
import tarfile
import time
import zipfile

EARLIEST = 315532800  # of a zip: 1980


def files(root, *patterns):
    """{path: bytes} below a folder."""
    found = {str(path.relative_to(root)): path.read_bytes() for pattern in patterns for path in pathlib.Path(root).glob(pattern)
             if path.is_file() and "__pycache__" not in path.parts}
    if not found:
        raise SystemExit(f"{root}: nothing matches {' '.join(patterns)}")
    return found


def zip_to(path, contents, epoch):
    at = time.gmtime(max(int(epoch), EARLIEST))[:6]
    with zipfile.ZipFile(path, "w") as archive:
        for name in sorted(contents):
            entry = zipfile.ZipInfo(name, at)
            entry.external_attr, entry.create_system = 0o100644 << 16, 3
            archive.writestr(entry, contents[name], zipfile.ZIP_DEFLATED, 9)


def tar_to(path, contents, epoch):
    raw = io.BytesIO()
    with tarfile.open(fileobj=raw, mode="w", format=tarfile.USTAR_FORMAT) as archive:
        for name in sorted(contents):
            entry = tarfile.TarInfo(name)
            entry.size, entry.mtime, entry.mode = len(contents[name]), int(epoch), 0o644
            archive.addfile(entry, io.BytesIO(contents[name]))
    pathlib.Path(path).write_bytes(gzip.compress(raw.getvalue(), 9, mtime=int(epoch)))
