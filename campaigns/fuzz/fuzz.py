#!/usr/bin/env python3
"""Fuzzing: runs the targets, keeps what made one fail, and shows that each finds the bugs planted for it.

    fuzz.py run SECONDS SEED      all of it (make fuzz); SECONDS are shared by the targets
    fuzz.py plants                the bugs planted, as NAME:TARGET:SOURCE
    fuzz.py plant NAME FILE       writes the source with that planted bug to FILE
"""
import hashlib
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import anchors

BUILD = pathlib.Path("build/fuzz")
SOURCES = pathlib.Path("host_tests/fuzz")
LISTS = (pathlib.Path("campaigns/breakages/breakages.txt"), pathlib.Path("checks/planted.txt"))
TARGETS = ("commands", "stream", "driver", "filters")
PLANTED_SECONDS = 60  # at most; found within some seconds as a rule
REDUCE_SECONDS = 10
FOUND = (1, -signal.SIGABRT)  # a sanitizer's complaint, a broken property; not 2 (cannot run), nor what another's signal ends


def planted():
    """[(name as a file, target, breakage)] of the lists' judge `fuzz`."""
    return [(re.sub(r"\W+", "-", entry.name), judge.split()[1], entry) for path in LISTS for entry in anchors.load(path)
            for judge in entry.judges if judge.split()[0] == "fuzz"]


def plants():
    """NAME:TARGET:SOURCE of each, for campaigns/fuzz/fuzz.mk."""
    for name, target, entry in planted():
        print(f"{name}:{target}:{anchors.broken(entry, source_text())[0]}")


def source_text():
    """The product's sources and the stream reader's, which has a fuzz target too."""
    return {**anchors.product_text(), "sim/model/stream.c": pathlib.Path("sim/model/stream.c").read_text(encoding="utf-8")}


def plant(name, path):
    for found, _, entry in planted():
        if found == name:
            file, text = anchors.broken(entry, source_text())
            pathlib.Path(path).write_text(f'#line 1 "{file}"\n' + text, encoding="utf-8")
            return
    sys.exit(f"fuzz: no breakage of {' and '.join(map(str, LISTS))} is called {name}")


def last_input(work):
    """What ran when the process ended: its length in four bytes, then the bytes."""
    data = (work / "current").read_bytes()
    return data[4:4 + int.from_bytes(data[:4], "little")]


def fails(binary, data, path):
    path.write_bytes(data)
    return subprocess.run([binary, path], capture_output=True, timeout=60).returncode != 0


def reduced(binary, data, path):
    """Shorter by pieces, as long as it still fails."""
    end = time.monotonic() + REDUCE_SECONDS
    size = max(1, len(data) // 2)
    while size >= 1 and time.monotonic() < end:
        at = 0
        while at < len(data) and time.monotonic() < end:
            shorter = data[:at] + data[at + size:]
            if fails(binary, shorter, path):
                data = shorter
            else:
                at += size
        size //= 2
    return data


def keep_failure(target, binary, data, said):
    """Reduces the input, keeps it under its hash and says how to run it again."""
    work = BUILD / target
    if fails(binary, data, work / "trial"):
        data = reduced(binary, data, work / "trial")
    (work / "trial").unlink()
    path = work / f"crash-{hashlib.sha1(data).hexdigest()[:12]}"
    path.write_bytes(data)
    print("\n".join("    " + line for line in said.strip().splitlines()[-12:]))
    print(f"    the input ({len(data)} bytes) is kept: {path}")
    print(f"    again: {binary} {path}")
    print(f"    once it is mended: cp {path} {SOURCES}/corpus/{target}/NAME-OF-THE-BUG")


def drive(binary, target, work, seconds, seed, folders):
    work.mkdir(parents=True, exist_ok=True)
    command = [binary, "--seconds", seconds, "--seed", seed, "--work", work]
    dictionary = SOURCES / f"{target}.dict"
    if dictionary.exists():
        command += ["--dict", dictionary]
    return subprocess.run([str(c) for c in command + folders], capture_output=True, text=True, errors="replace",
                          timeout=4 * seconds + 300)


def run_target(target, seconds, seed):
    """gcc's build; committed inputs first, then those found in earlier runs."""
    work = BUILD / target
    binary = BUILD / f"fuzz_{target}"
    (work / "corpus").mkdir(parents=True, exist_ok=True)
    done = drive(binary, target, work, seconds, seed, [SOURCES / "corpus" / target, work / "corpus"])
    good = done.returncode == 0
    print(f"fuzz {target}: {done.stdout.strip() if good else f'FAILED (status {done.returncode})'}", flush=True)
    if not good:
        keep_failure(target, binary, last_input(work), done.stderr)
    return good


def run_libfuzzer(target, seconds, seed):
    work = BUILD / target
    kept = work / "libfuzzer"
    kept.mkdir(parents=True, exist_ok=True)
    binary = BUILD / f"libfuzzer_{target}"
    command = [binary, f"-max_total_time={seconds}", f"-seed={seed}", "-max_len=600", "-timeout=20", "-print_final_stats=1", "-verbosity=0",
               f"-artifact_prefix={work}/", kept, SOURCES / "corpus" / target, work / "corpus"]
    dictionary = SOURCES / f"{target}.dict"
    if dictionary.exists():
        command.insert(1, f"-dict={dictionary}")
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, errors="replace", timeout=4 * seconds + 300)
    count = [line.split()[1] for line in done.stderr.splitlines() if line.startswith("stat::number_of_executed_units")]
    if done.returncode == 0 and count and int(count[0]) > 0:
        print(f"libFuzzer {target}: {count[0]} inputs", flush=True)
        return True
    print(f"libFuzzer {target}: FAILED (status {done.returncode}, {count[0] if count else 'unknown number of'} inputs)")
    print("\n".join("    " + line for line in done.stderr.strip().splitlines()[-20:]))
    print(f"    again: {binary} {work}/crash-...", flush=True)
    return False


def reason(stderr):
    """The line by which a property or a sanitizer says what is wrong, or nothing."""
    found = re.search(r"^\S+:\d+: .+$|^\S+:\d+:\d+: runtime error: .+$|ERROR: AddressSanitizer: .+$", stderr, re.M)
    return found[0][:120] if found else ""


def run_planted(name, target, seed):
    """Must fail by the bug; a fresh work folder, so that nothing found earlier helps."""
    work = BUILD / "planted" / f"{name}.work"
    for old in sorted(work.glob("**/*"), reverse=True):
        if old.is_file():
            old.unlink()
    began = time.monotonic()
    done = drive(BUILD / "planted" / name, target, work, PLANTED_SECONDS, seed, [SOURCES / "corpus" / target])
    took = time.monotonic() - began
    said = reason(done.stderr)
    if done.returncode not in FOUND or not said:
        print(f"planted {name}: SURVIVED {took:.1f} s of {target}, status {done.returncode}: {(done.stdout + done.stderr).strip()[-200:]}",
              flush=True)
        return False
    print(f"planted {name}: found by {target} in {took:.1f} s: {said}", flush=True)
    return True


def run(seconds, seed):
    libfuzzer = all((BUILD / f"libfuzzer_{t}").exists() for t in TARGETS) and os.environ.get("LIBFUZZER", "") == "yes"
    share = max(1, int(seconds / len(TARGETS) / (2 if libfuzzer else 1)))
    print(f"seed {seed}, {share} s a target" + ("" if libfuzzer else "; no clang with -fsanitize=fuzzer here: gcc's driver alone"))
    results = [run_target(t, share, seed) for t in TARGETS]
    if libfuzzer:
        results += [run_libfuzzer(t, share, seed) for t in TARGETS]
    results += [run_planted(name, target, seed) for name, target, *_ in planted()]
    print(f"skipped: {0 if libfuzzer else len(TARGETS)}")
    print(f"{sum(results)} passed, {len(results) - sum(results)} failed")
    return 0 if all(results) else 1


def main():
    if len(sys.argv) == 4 and sys.argv[1] == "run":
        try:
            seconds, seed = int(sys.argv[2]), int(sys.argv[3])
        except ValueError:
            sys.exit(f"fuzz: SECONDS={sys.argv[2]} SEED={sys.argv[3]}: whole numbers, please")
        if seconds < 1 or seed < 0:
            sys.exit(f"fuzz: SECONDS={seconds} SEED={seed}: at least 1 second and a seed from 0 on")
        return run(seconds, seed)
    if len(sys.argv) == 4 and sys.argv[1] == "plant":
        plant(sys.argv[2], sys.argv[3])
        return 0
    if sys.argv[1:] == ["plants"]:
        plants()
        return 0
    sys.exit(__doc__)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except anchors.Lost as why:
        sys.exit(f"fuzz: {why}")
