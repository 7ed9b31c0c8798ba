"""platformio.ini with PlatformIO Core, against packages that stand in for its registry's (mk/scripts/pio_standins.py): lint, both
environments built and their results compared with make's, pio test. Each result is looked at itself: pio's exit status is not reliable."""
import ast
import json
import os
import pathlib
import shutil
import subprocess
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import OUT, SIMRUN, STREAMS, FW, Skip, read_output, run, run_all, test
from laws import PLAIN  # noqa: E402
import boards  # noqa: E402

PIO = pathlib.Path("build/venv-pio/bin/pio").absolute()
FOLDER = pathlib.Path("build/pio").absolute()
UNITY = pathlib.Path(os.environ.get("UNITY_DIR", "build/unity"))
STREAM = STREAMS / "tilt-fast.csv"


def pio(*arguments, folder="."):
    if not PIO.exists():
        raise Skip("no PlatformIO in build/venv-pio (make piocheck)")
    settings = {"PLATFORMIO_CORE_DIR": FOLDER / "core", "PLATFORMIO_WORKSPACE_DIR": FOLDER / "work", "PLATFORMIO_SETTING_ENABLE_TELEMETRY": "no",
                "PLATFORMIO_NO_ANSI": "true", "PLATFORMIO_SETTING_CHECK_PLATFORMIO_INTERVAL": "10000"}
    return subprocess.run([str(PIO), *arguments], capture_output=True, text=True, timeout=300, cwd=folder,
                          env={**os.environ, **{k: str(v) for k, v in settings.items()}})


class NoLint(AssertionError):
    """pio stopped before it could lint."""


def lint(folder):
    """Errors and warnings; Core 6.2.0 prints them as Python does, not as JSON, and always ends with 0."""
    done = pio("project", "config", "--lint", "--json-output", folder=folder)
    try:
        return ast.literal_eval(done.stdout.strip())
    except (SyntaxError, ValueError):
        raise NoLint(f"pio printed no lint: {done.stdout}{done.stderr}") from None


def changed_ini(name, old, new):
    folder = FOLDER / name
    folder.mkdir(parents=True, exist_ok=True)
    text = pathlib.Path("platformio.ini").read_text(encoding="utf-8")
    assert old in text, old
    (folder / "platformio.ini").write_text(text.replace(old, new, 1), encoding="utf-8")
    return folder


def stand_in_unity(environment):
    """pio wants it for every environment as soon as there are tests."""
    if not (UNITY / "unity.c").exists():
        raise Skip("no Unity in build/unity (tools/deps.sh test)")
    target = FOLDER / "work" / "libdeps" / environment / "Unity"
    (target / "src").mkdir(parents=True, exist_ok=True)
    for file in UNITY.glob("unity*.[ch]"):
        shutil.copy(file, target / "src")
    (target / "library.json").write_text(json.dumps({"name": "Unity", "version": "2.6.1"}), encoding="ascii")
    spec = {"owner": "throwtheswitch", "id": 1, "name": "Unity", "requirements": None, "uri": None}
    (target / ".piopm").write_text(json.dumps({"type": "library", "name": "Unity", "version": "2.6.1", "spec": spec}), encoding="ascii")


def built(environment, program):
    path = FOLDER / "work" / "build" / environment / program
    path.unlink(missing_ok=True)
    stand_in_unity(environment)
    done = pio("run", "-e", environment)
    assert path.exists(), f"pio run -e {environment} left no {path}: {done.stdout[-600:]}{done.stderr[-300:]}"
    return path


@test
def lint_finds_nothing():
    found = lint(".")
    assert found == {"errors": [], "warnings": []}, found


@test
def lint_notices_an_unknown_option_and_a_broken_file():
    found = lint(changed_ini("ini-option", "build_src_filter", "build_src_fitler"))
    assert found["warnings"] and "build_src_fitler" in str(found["warnings"]), found
    try:
        found = lint(changed_ini("ini-broken", "[env:uno]", "[env:uno"))
    except NoLint as problem:
        assert "ini-broken" in str(problem), problem
    else:
        assert found["errors"], found


@test
def uno_fits_the_flash():
    sizes = subprocess.run(["avr-size", built("uno", "firmware.elf")], capture_output=True, text=True, check=True).stdout
    text, data = map(int, sizes.splitlines()[1].split()[:2])
    assert text + data <= boards.TABLE["uno"].flash, sizes


@test
def uno_runs_as_the_firmware_of_make():
    image = built("uno", "firmware.elf")
    for name, fw in (("pio-uno", image), ("make-uno", FW)):
        run(SIMRUN, "--fw", fw, "--in", STREAM, "--out", OUT / f"{name}.csv", "--cmd", "500:filter median")
    (ours, our_notes), (theirs, their_notes) = (read_output(OUT / f"{name}.csv")[:2] for name in ("make-uno", "pio-uno"))
    assert len(ours) > 1000 and [r[1:] for r in ours] == [r[1:] for r in theirs], (len(ours), len(theirs))
    assert our_notes == their_notes and any("filter is one of" in note for note in our_notes), (our_notes, their_notes)


@test
def native_gives_the_rows_of_make():
    program = built("native", "program")
    for name, binary in (("pio-native", program), ("make-native", "build/host/native_replay")):
        run(binary, "--in", STREAM, "--out", OUT / f"{name}.csv", "--filter", PLAIN)
    ours, theirs = (read_output(OUT / f"{name}.csv")[0] for name in ("make-native", "pio-native"))
    assert len(ours) > 1000 and ours == theirs, (len(ours), len(theirs))


@test
def a_source_that_does_not_compile_leaves_no_program():
    """What the two tests above rest on: a missing folder in the filter of sources shows."""
    folder = changed_ini("ini-source", "    +<hal/host/>\n", "")
    for name in ("firmware", "hal", "lib", "sim", "host_tests"):
        link = folder / name
        if not link.is_symlink():
            link.symlink_to(pathlib.Path(name).absolute())
    path = FOLDER / "work" / "build" / "native" / "program"
    path.unlink(missing_ok=True)
    stand_in_unity("native")
    done = pio("run", "-e", "native", folder=folder)
    assert "undefined reference" in done.stdout + done.stderr, done.stdout[-600:]
    assert not path.exists()


USER_INI = """[env:user]
platform = native
lib_deps = file://{}
"""
# a file of C++ and one of C, as others' projects have them
USER_SOURCES = {"main.cpp": """#include <stdio.h>
#include <tilt_filter.h>
extern "C" int32_t filtered_plain(void);
static tilt_filter_t tilt;
int main()
{
    tilt_filter_begin(&tilt, 100);
    for (int i = 0; i < 200; i++) {
        tilt_filter_update(&tilt, 0, 212, 154);
    }
    printf("%d %d %ld\\n", tilt.angles.roll_cdeg, tilt.flags, (long)filtered_plain());
}
""", "number.c": """#include <filter.h>
int32_t filtered_plain(void);
int32_t filtered_plain(void)
{
    filter_t f;
    filter_config_t config = filter_defaults(&filter_law_PLAIN, 1000);
    (void)filter_init(&f, &filter_law_PLAIN, &config);
    for (int i = 0; i < 200; i++) {
        (void)filter_update(&f, 77);
    }
    return f.x_lsb_q16 >> 16;
}
""".replace("PLAIN", PLAIN)}


@test
def a_project_of_its_own_installs_the_library_from_its_zip():
    folder = FOLDER / "library-user"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.rmtree(FOLDER / "work" / "libdeps" / "user", ignore_errors=True)
    (folder / "src").mkdir(parents=True)
    (folder / "platformio.ini").write_text(USER_INI.format(pathlib.Path("build/library/tilt-filters.zip").absolute()), encoding="utf-8")
    for name, text in USER_SOURCES.items():
        (folder / "src" / name).write_text(text, encoding="utf-8")
    program = FOLDER / "work" / "build" / "user" / "program"
    program.unlink(missing_ok=True)
    done = pio("run", "-e", "user", folder=folder)
    assert program.exists(), f"{done.stdout[-600:]}{done.stderr[-300:]}"
    # 212 / 265 g and 154 / 256 g: atan2 is 53.06 degrees
    roll_cdeg, flags, plain = (int(word) for word in run(program).stdout.split())
    assert abs(roll_cdeg - 5306) <= 3 and flags == 0 and plain == 77, (roll_cdeg, flags, plain)


@test
def pio_test_runs_the_unity_tests():
    stand_in_unity("native")
    report = FOLDER / "test.json"
    report.unlink(missing_ok=True)
    done = pio("test", "-e", "native", "--json-output-path", str(report))
    assert report.exists(), done.stdout[-600:]
    suites = json.loads(report.read_text(encoding="utf-8"))["test_suites"]
    native = next(s for s in suites if s["env_name"] == "native" and s["test_name"] == "test_tilt")
    assert native["status"] == "PASSED" and native["testcase_nums"] >= 10 and native["failure_nums"] == 0, (native["status"], done.stdout[-600:])


if __name__ == "__main__":
    raise SystemExit(run_all())
