"""What make release packs: equal bytes whatever the files' times, the umask and the time zone; a wheel that installs and works without a compiler;
and a refusal where the change log or the tree is not a release's."""
import ast
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import OUT, Skip, run, run_all, test
from laws import DEFAULT  # noqa: E402
from library import VERSION  # noqa: E402
import wheel  # noqa: E402

PARTS = ("lib", "firmware", "hal", "sim", "tools", "web", "mk", "host_tests/tools/libtilt", "host_tests/support", "LICENSE", "CHANGELOG.md")
EPOCH, VENV = "1700000000", pathlib.Path("build/venv")
STREAM = pathlib.Path("sim/streams/rest-2lsb.csv").resolve()
LSB = 0.004 * 9.80665  # m/s2, as a common sketch prints them
NAMED = ("build/uno/firmware.hex", "build/library/tilt-filters.zip", "build/release/libtilt.args")


def tree(name, parts=(*PARTS, *NAMED)):
    """A copy of what is packed, with times of its own, and stand-ins for the demo and a small image."""
    root = OUT.resolve() / name
    shutil.rmtree(root, ignore_errors=True)
    for part in parts:
        (root / part).parent.mkdir(parents=True, exist_ok=True)
        if pathlib.Path(part).is_dir():
            shutil.copytree(part, root / part, copy_function=shutil.copyfile, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copyfile(part, root / part)
    for stream in set(root.glob("sim/streams/*.csv")) - {root / "sim/streams" / STREAM.name}:
        stream.unlink()
    (root / "demo.html").write_text("<p>demo\n", encoding="ascii")
    return root


def pack(root, umask=0o022, zone="UTC", **more):
    everyday = "build/uno/firmware.hex"
    return subprocess.run([sys.executable, "-B", "mk/scripts/release.py", "pack", "dist", EPOCH, "build/release/libtilt.args", "demo.html",
                           "build/library/tilt-filters.zip", f"everyday-16mhz={everyday}", f"small-16mhz={everyday}", f"everyday-8mhz={everyday}"],
                          cwd=root, env={**os.environ, "TZ": zone, **more}, capture_output=True, text=True, preexec_fn=lambda: os.umask(umask))


def packed(root, *how, **more):
    done = pack(root, *how, **more)
    assert done.returncode == 0, done.stderr
    return {path.name: path.read_bytes() for path in sorted((root / "dist").iterdir())}


@test
def packing_twice_gives_equal_bytes():
    root = tree("first")
    first = packed(root)
    assert len(first) == 9 and f"tilt-uno-{VERSION}-everyday-16mhz.hex" in first, list(first)
    assert not any("-8mhz" in name for name in first), "an image that no board of its clock has room for"
    for path in root.rglob("*"):
        os.utime(path, (2e9, 2e9))
    second = packed(root, 0o077, "Pacific/Auckland", PYTHONHASHSEED="7")
    assert {name: hashlib.sha256(data).hexdigest() for name, data in second.items()} == {n: hashlib.sha256(d).hexdigest() for n, d in first.items()}
    run("sh", "-c", f"cd {root / 'dist'} && sha256sum --quiet -c SHA256SUMS")
    (root / "build/uno/firmware.elf").write_bytes(b"\0" + os.fsencode(root) + b"\0")
    named = pack(root)
    assert named.returncode == 1 and "firmware.elf has this folder's name in it" in named.stderr, named
    assert (root / "dist/SHA256SUMS").exists(), "what was there is left alone"


def installed(root):
    """The program `tilt` of the wheel in an environment of its own, which sees the packages it depends on and nothing else of this tree."""
    if not (VENV / "bin/tilt").exists():
        raise Skip("no build/venv/bin/tilt: sh tools/deps.sh tilt")
    place = root / "venv"
    run(VENV / "bin/python", "-m", "venv", "--without-pip", place)
    (wheel,) = (root / "dist").glob("*.whl")
    run(VENV / "bin/python", "-m", "pip", "--python", place / "bin/python", "install", "--no-deps", "--no-index", "--no-compile", "-q", wheel)
    names = {path.name for path in place.glob("lib/*/site-packages/*.dist-info/LICENSE*")}
    assert names == {"LICENSE", "LICENSE-avr-libc"}, names  # the images contain parts of avr-libc
    (site,) = place.glob("lib/*/site-packages")
    (theirs,) = VENV.resolve().glob("lib/*/site-packages")
    (site / "dependencies.pth").write_text(f"{theirs}\n", encoding="utf-8")
    return place / "bin/tilt"


@test
def the_project_lists_what_is_imported_and_every_folder():
    named = {"serial": "pyserial", "PIL": "pillow"}
    trees = [ast.parse(path.read_text(encoding="utf-8")) for path in pathlib.Path("tools/tilt").rglob("*.py")]
    nodes = [node for each in trees for node in ast.walk(each)]
    found = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
    found |= {node.module for node in nodes if isinstance(node, ast.ImportFrom) and not node.level}
    found = {name.split(".")[0] for name in found} - set(sys.stdlib_module_names) - {"tilt", "boards"}
    listed = {re.match(r"\w+", each)[0] for each in wheel.project()["project"]["dependencies"]}
    assert {named.get(name, name) for name in found} == listed, found
    folders = {".".join(path.parent.parts[1:]) for path in pathlib.Path("tools/tilt").rglob("__init__.py")}
    packages = set(wheel.project()["tool"]["setuptools"]["packages"])
    assert packages == folders | {"tilt.web"}, packages ^ folders


def said(tilt, folder, *words, path="", **more):
    """(status, stdout, stderr) in this folder, where PATH has no compiler unless one is given."""
    done = subprocess.run([str(tilt), *map(str, words)], cwd=folder, env={"PATH": path or str(folder), "HOME": str(folder), **more},
                          capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


@test
def the_wheel_works_without_a_compiler_and_with_one():
    root = OUT.resolve() / "first"
    tilt, folder = installed(root), root / "work"
    folder.mkdir()
    assert said(tilt, folder, "--version") == (0, f"tilt {VERSION}\n", "")
    status, out, _ = said(tilt, folder, "--help")
    assert status == 0 and "flash" in out, out
    rows = (f"X: {k * 37 % 90 * LSB:.2f}  Y: {k % 9 * LSB:.2f}  Z: {250 * LSB:.2f} m/s^2\n" for k in range(300))
    (folder / "log.txt").write_text("".join(rows), encoding="ascii")
    status, _, err = said(tilt, folder, "import", "log.txt", "--rate", "100", "-o", "log.csv")
    assert status == 0 and (folder / "log.csv").exists(), err
    status, _, err = said(tilt, folder, "plot", "log.csv", MPLCONFIGDIR=str(folder))
    assert status == 0 and (folder / "log.png").exists(), err
    replay = ("replay", STREAM, "--filter", DEFAULT, "-o", "out.csv")
    status, _, err = said(tilt, folder, *replay)
    assert status == 2 and "install gcc or clang" in err and err.count("\n") == 1, err
    status, _, err = said(tilt, folder, "nav")
    assert status == 2 and "run it in a checkout" in err and err.count("\n") == 1, err
    image = f"tilt flash PORT --image tilt-uno-{VERSION}-nav-16mhz.hex\n"
    assert said(tilt.with_name("python"), folder, "-c", "from tilt.navigation import boards; print(boards.NAVFLASH)") == (0, image, "")
    status, out, err = said(tilt, folder, "flash", "/dev/ttyUSB99")
    assert status == 1 and "tilt/images/everyday-16mhz.hex, " in out and "flash: avrdude is not installed" in err and err.count("\n") == 1, (out, err)
    (folder / "quick-cc").write_text('#!/bin/sh\nexec gcc "$@" -O0\n', encoding="ascii")
    (folder / "quick-cc").chmod(0o755)
    status, _, err = said(tilt, folder, *replay, path=os.environ["PATH"], CC=str(folder / "quick-cc"))
    assert status == 0, err
    run(VENV / "bin/tilt", "replay", STREAM, "--filter", DEFAULT, "-o", folder / "checkout.csv")
    assert (folder / "out.csv").read_bytes() == (folder / "checkout.csv").read_bytes()


@test
def an_installation_without_sources_says_so():
    bare = OUT.resolve() / "bare"
    shutil.rmtree(bare, ignore_errors=True)
    shutil.copytree("tools/tilt", bare / "lib/tilt", ignore=shutil.ignore_patterns("__pycache__"))
    status, _, err = said(sys.executable, bare, "-B", "-m", "tilt", "--version", PYTHONPATH=str(bare / "lib"))
    assert status == 1 and err.startswith("tilt: installed without its sources: ") and err.count("\n") == 1, err


@test
def the_simulator_builds_from_its_archive():
    root = OUT.resolve() / "first"
    run("tar", "-xzf", root / f"dist/simrun-{VERSION}.tar.gz", "-C", root)  # tarfile's filter came with Python 3.11.4, Debian 12 has 3.11.2
    place = root / f"simrun-{VERSION}"
    run("make", "-s", "-C", place, "CFLAGS=-O0")
    stream = place / "sim/streams" / STREAM.name
    run(place / "simrun", "--fw", "build/uno/firmware.elf", "--in", stream, "--out", root / "rows.csv", "--max-ms", "100")
    assert b"# tilt-uno" in (root / "rows.csv").read_bytes()


@test
def what_is_no_release_is_refused():
    root = tree("unready", ("mk", "firmware", "CHANGELOG.md"))
    log = root / "CHANGELOG.md"

    def judged(**more):
        done = subprocess.run([sys.executable, "-B", "mk/scripts/release.py", "judge"], cwd=root, env={**os.environ, **more},
                              capture_output=True, text=True)
        return done.returncode, done.stderr

    (root / ".gitignore").write_text("/build/\n", encoding="ascii")
    for command in (["init", "-q"], ["add", "."], ["-c", "user.name=x", "-c", "user.email=x", "commit", "-qm", "x"]):
        run("git", "-C", root, *command)
    text = log.read_text(encoding="utf-8")
    top = text.split("\n## ", 1)[1].split("\n")[0]
    for heading, status, words in ((VERSION, 0, ""), ("9.9.9", 1, f"begins with '9.9.9', the version in firmware/console/version.h is {VERSION}")):
        log.write_text(text.replace(f"## {top}", f"## {heading}", 1), encoding="utf-8")
        run("git", "-C", root, "-c", "user.name=x", "-c", "user.email=x", "commit", "-qam", "x", "--allow-empty")
        found = judged()
        assert found[0] == status and words in found[1], found
    (root / "stray.c").write_text("", encoding="ascii")
    assert "release: not committed: stray.c\n" in judged()[1]
    status, err = judged(GIT_DIR="/nowhere")
    assert status == 1 and "\nrelease: no git checkout (" in err and err.count("\n") == 2, err
    done = subprocess.run([sys.executable, "-B", "mk/scripts/release.py", "pack", "dist", "", "a", "b", "c", "d=e"], cwd=root,
                          capture_output=True, text=True)
    assert done.returncode == 1 and done.stderr.startswith("release: '' is no time for the archives: ") and done.stderr.count("\n") == 1, done.stderr
    recipe = subprocess.run(["make", "-n", "release"], capture_output=True, text=True, check=True).stdout
    assert recipe.index("release.py judge") < recipe.index("check_pages.py --strict") < recipe.index("release.py pack"), recipe


if __name__ == "__main__":
    raise SystemExit(run_all())
