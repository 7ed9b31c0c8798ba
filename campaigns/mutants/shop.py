"""The workshop under build/mutants: a copy of the tree for each worker, what is compiled from it, and one way to run a program."""
import fcntl
import hashlib
import json
import math
import os
import pathlib
import shutil
import subprocess
import threading

ROOT = pathlib.Path("build/mutants").resolve()
COPIED = ("lib", "firmware", "nav", "hal", "sim", "host_tests", "tools", "checks", "campaigns/faults", "campaigns/tests", "mk",
          "Makefile")


class Stop(Exception):
    """What ends the campaign: cause, place and remedy in one line."""


def alone():
    """Two campaigns would break each other's copies: the lock is held as long as what this returns is open."""
    ROOT.mkdir(parents=True, exist_ok=True)
    lock = (ROOT / "lock").open("w", encoding="utf-8")
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        raise Stop(f"another campaign works in {ROOT}: wait until it ends, or end it") from None
    return lock


def digest(*parts):
    whole = hashlib.sha256()
    for part in parts:
        whole.update(part if isinstance(part, bytes) else str(part).encode())
        whole.update(b"\0")
    return whole.hexdigest()[:20]


def tree_files():
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard", "--", *COPIED], capture_output=True, text=True, check=True).stdout
    return [name for name in listed.splitlines() if pathlib.Path(name).is_file()]


def copy_tree(worker):
    """The worker's copy, equal to the tree now: what a killed run left broken is whole again, what is gone is gone."""
    target = ROOT / f"tree{worker}"
    names = tree_files()
    for name in names:
        source, copy = pathlib.Path(name), target / name
        if not copy.exists() or copy.read_bytes() != source.read_bytes():
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, copy)
    known = set(names)
    for path in [p for folder in COPIED for p in (target / folder).rglob("*") if p.is_file()]:
        if str(path.relative_to(target)) not in known and "__pycache__" not in path.parts:
            path.unlink()
    (target / "build").mkdir(exist_ok=True)
    for shared in ("unity", "venv"):
        link = target / "build" / shared
        if not link.is_symlink() and pathlib.Path("build", shared).exists():
            link.symlink_to(pathlib.Path("build", shared).resolve())
    return target


def run(command, cwd, limit_s=300, **environment):
    """(status, output); a program that does not end in time has status None."""
    env = {**os.environ, "LC_ALL": "C", **environment}
    with subprocess.Popen([str(word) for word in command], cwd=cwd, env=env, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, start_new_session=True) as program:
        try:
            said = program.communicate(timeout=limit_s)[0]
        except subprocess.TimeoutExpired:
            os.killpg(program.pid, 9)
            program.communicate()
            return None, ""
        return program.returncode, said.decode("utf-8", "replace")


def timed(command, cwd, limit_s, output=subprocess.DEVNULL, **environment):
    """(status, seconds of the processor). The limit is of the processor's time, so a loaded machine makes no hang (status -9 or -24); a
    program that sleeps is ended after twenty times as long, with all that it started.
    """
    settings = [f"{name}={value}" for name, value in environment.items()]  # for the program alone: some name what is loaded before it
    words = ["prlimit", f"--cpu={math.ceil(limit_s)}", "--core=0", "env", *settings, *map(str, command)]
    program = subprocess.Popen(words, cwd=cwd, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.DEVNULL, start_new_session=True)
    asleep = threading.Timer(60 + 20 * limit_s, os.killpg, (program.pid, 9))
    asleep.start()
    try:
        _, status, usage = os.wait4(program.pid, 0)
    except BaseException:
        os.killpg(program.pid, 9)
        raise
    finally:
        asleep.cancel()
    program.returncode = os.waitstatus_to_exitcode(status)  # or Popen would wait for it once more
    return program.returncode, usage.ru_utime + usage.ru_stime


def plain(source):
    """`n9f:nav/lib/nav.c` is that file in one of its variants."""
    return source.rsplit(":", 1)[-1]


class Compiler:
    """Objects of unbroken sources, kept as long as nothing that they include changes."""

    def __init__(self, name, command, tree):
        self.folder, self.command, self.tree = ROOT / name, command, tree
        self.guard, self.locks, self.known, self.hashes = threading.Lock(), {}, {}, {}

    def named(self, name, command):
        return Compiler(name, command, self.tree)

    def path(self, source):
        return self.folder / (source.replace("/", "__") + ".o")

    def hash_of(self, name):
        if name not in self.hashes:
            path = self.tree / name
            self.hashes[name] = digest(path.read_bytes()) if path.exists() else ""
        return self.hashes[name]

    def object(self, source):
        """The object's path, compiled if need be."""
        with self.guard:
            lock = self.locks.setdefault(source, threading.Lock())
        with lock:
            if source not in self.known:
                self.known[source] = self.make(source)
        return self.path(source)

    def make(self, source):
        target, note = self.path(source), self.path(source).with_suffix(".json")
        command = self.command(source)
        if target.exists() and note.exists():
            kept = json.loads(note.read_text(encoding="utf-8"))
            if kept["command"] == command and all(self.hash_of(name) == was for name, was in kept["deps"].items()):
                return kept["deps"]
        target.parent.mkdir(parents=True, exist_ok=True)
        depends = target.with_suffix(".d")
        status, said = run([*command, "-MMD", "-MF", depends, "-c", plain(source), "-o", target], self.tree)
        if status != 0:
            raise Stop(f"{source} does not compile as it stands: {said.strip().splitlines()[0] if said.strip() else status}")
        names = depends.read_text(encoding="utf-8").replace("\\\n", " ").split(":", 1)[1].split()
        deps = {os.path.normpath(name): self.hash_of(os.path.normpath(name)) for name in names if not name.startswith("/")}
        note.write_text(json.dumps({"command": command, "deps": deps}), encoding="utf-8")
        return deps

    def deps(self, source):
        self.object(source)
        return self.known[source]

    def broken(self, tree, source, target):
        """Compiles the source in a worker's tree: the object's bytes, None where it does not compile."""
        status, _ = run([*self.command(source), "-c", plain(source), "-o", target], tree, CCACHE_DISABLE="1")  # nobody compiles it twice
        return target.read_bytes() if status == 0 else None
