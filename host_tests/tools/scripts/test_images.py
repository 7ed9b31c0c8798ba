"""Which filters are in which image: FILTERS= of make, mk/scripts/filters_txt.sh, the image that holds a filter; and that the filter with which the
firmware starts is the one that docs/results/default-filter.md decides for, wherever it is named."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
from unittest import mock

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import DEFAULT, PLAIN, ROBUST, SLOWEST  # noqa: E402
import boards
import default_filter
import results
import default_score as score
import link_image
import system_support
from system_support import refused, run_all, test

OUT, EVERYDAY = pathlib.Path("build/images-test"), "build/uno/firmware.elf"
IMAGES = pathlib.Path("mk/images.mk").read_text(encoding="utf-8")
SETS = {name: names.split() for name, names in re.findall(r"^FILTERS_([a-z]+) *:= *(.*)$", IMAGES, re.M)}
SMALL = SETS.pop("small")  # no image of its own: what boards with less flash get
FLAG = re.compile(r"-DFILTER_LIST\(X\)= ?((?:X\(\w+\) ?)+)")
# FILTERS, what the sentence names
BAD = (("kff", "no filter kff: choose"), (f"{PLAIN} kff", "no filter kff: choose"), (PLAIN.upper(), f"no filter {PLAIN.upper()}: choose"),
       (f"{PLAIN},{ROBUST}", f"no filter {PLAIN},{ROBUST}: choose"), (f"{PLAIN} {ROBUST} {PLAIN}", f"named twice: {PLAIN}"),
       (f"{ROBUST} {PLAIN} {PLAIN} {ROBUST}", f"named twice: {PLAIN} {ROBUST}"),
       ("", "FILTERS is empty:"), ("  ", "FILTERS is empty:"), (f"everyday {PLAIN}", "no filter everyday: choose"),
       (f"{PLAIN} robust", "no filter robust: choose"), ("everyday robust", "no filter everyday: choose"))


def listed(*flags):
    """FILTER_LIST as the preprocessor has it."""
    source = '#include "filter_list.h"\n#define NAME(name) name\nlist: FILTER_LIST(NAME)\n'
    command = ["gcc", "-E", "-P", "-Ilib/machine/src", "-Ilib/filters/src", *flags, "-xc", "-"]
    done = subprocess.run(command, input=source, capture_output=True, text=True, timeout=600, check=True)
    return done.stdout.split("list:")[1].split()


EVERY = listed()


def make(*words, dry=False):
    command = ["make", "--no-print-directory", f"U={OUT}", *(["-n"] if dry else []), *words]
    return subprocess.run(command, capture_output=True, text=True, timeout=600)


def chosen_by_make(filters):
    """What make writes into filters.txt for FILTERS, and the list in its compiler's flag."""
    target = OUT / "filters.txt"
    target.unlink(missing_ok=True)
    done = make(str(target), *filters)
    assert done.returncode == 0, (filters, done.stderr)
    dry = make(str(OUT / "firmware.elf"), *filters, dry=True)
    flags = {found for line in dry.stdout.splitlines() if " -c firmware/" in line for found in FLAG.findall(line)}
    assert dry.returncode == 0 and len(flags) == 1, (filters, dry.stderr, flags)
    return target.read_text(encoding="ascii").split(), re.findall(r"X\((\w+)\)", flags.pop())


@test
def every_filter_is_in_a_set_and_no_set_has_strange_ones():
    order = re.search(r"^FILTER_SETS *:= *(.*)$", IMAGES, re.M).group(1).split()
    assert order == list(SETS) and len(order) >= 3, order
    assert {name for names in SETS.values() for name in names} == set(EVERY), SETS
    assert all(len(names) == len(set(names)) for names in SETS.values()), SETS
    assert set(SMALL) < set(SETS[order[0]]) and SMALL[0] == SETS[order[0]][0], SMALL  # tested with the first set


@test
def filters_are_taken_in_the_order_given():
    first = SETS[next(iter(SETS))]
    for words, wanted in (([], first), (["BOARD=nano"], first), (["BOARD=nano-old"], SMALL), (["FILTERS=small"], SMALL),
                          ([f"FILTERS={ROBUST}", "BOARD=promini"], [ROBUST]), *((["FILTERS=" + name], names) for name, names in SETS.items()),
                          ([f"FILTERS={SLOWEST}"], [SLOWEST]), ([f"FILTERS={ROBUST} {PLAIN}"], [ROBUST, PLAIN]),
                          ([f"FILTERS={PLAIN}  {ROBUST} "], [PLAIN, ROBUST]),
                          ([f"FILTERS={SLOWEST} {DEFAULT} {PLAIN}"], [SLOWEST, DEFAULT, PLAIN])):
        text, flag = chosen_by_make(words)
        assert text == wanted and flag == wanted, (words, text, flag)


@test
def each_filter_can_be_chosen_alone():
    target = OUT / "alone" / "filters.txt"
    for name in EVERY:
        target.unlink(missing_ok=True)
        done = subprocess.run(["sh", "mk/scripts/filters_txt.sh", str(target), name], capture_output=True, text=True, timeout=600)
        assert done.returncode == 0 and not done.stdout + done.stderr and target.read_text(encoding="ascii") == name + "\n", (name, done)


@test
def what_is_chosen_already_is_left_alone():
    target = OUT / "kept" / "filters.txt"
    for words, anew in (([PLAIN, ROBUST], True), ([PLAIN, ROBUST], False), ([ROBUST, PLAIN], True), ([ROBUST], True)):
        before = target.stat().st_mtime_ns if target.exists() else None
        if before is not None:
            subprocess.run(["touch", "-d", "2001-01-01", str(target)], check=True)
            before = target.stat().st_mtime_ns
        subprocess.run(["sh", "mk/scripts/filters_txt.sh", str(target), *words], check=True, timeout=600)
        assert (target.stat().st_mtime_ns != before) == anew and target.read_text(encoding="ascii").split() == words, words


@test
def what_cannot_be_chosen_is_refused_in_one_sentence():
    target = OUT / "bad" / "filters.txt"
    for filters, sentence in BAD:
        target.unlink(missing_ok=True)
        done = subprocess.run(["sh", "mk/scripts/filters_txt.sh", str(target), *filters.split()], capture_output=True, text=True, timeout=600)
        assert done.returncode == 2 and done.stdout == "" and done.stderr.count("\n") == 1, (filters, done)
        assert done.stderr.startswith("FILTERS") and sentence in done.stderr.strip() + ";" and not target.exists(), (filters, done.stderr)
        if "twice" not in sentence:
            assert all(f" {name}" in done.stderr for name in (*EVERY, *SETS, "small")), done.stderr
    for filters, sentence in BAD[:1] + BAD[4:5] + BAD[6:7] + BAD[8:9]:
        (OUT / "filters.txt").unlink(missing_ok=True)
        done = make(str(OUT / "firmware.elf"), f"FILTERS={filters}")
        said = [line for line in done.stderr.splitlines() if line.startswith("FILTERS")]
        assert done.returncode != 0 and len(said) == 1 and sentence in said[0] + ";", (filters, done.stderr)
        assert not (OUT / "filters.txt").exists() and not (OUT / "firmware.elf").exists(), filters


@test
def the_image_with_a_filter_holds_it():
    """make's and the tests' own: the chosen image where it does, else the first set's that does."""
    show = f"show: ; @$(foreach f,{' '.join(EVERY)},echo '$(f) $(call image_with,$(f))';)"
    for choice in (*SETS, f"{ROBUST} {PLAIN}", SLOWEST):
        holds = {f"{OUT}/firmware.elf": SETS.get(choice, choice.split()), **{f"{OUT}/{name}/firmware.elf": names for name, names in SETS.items()}}
        wanted = {name: next(image for image, names in holds.items() if name in names) for name in EVERY}
        done = make("--eval", show, "show", f"FILTERS={choice}")
        assert done.returncode == 0 and dict(line.split() for line in done.stdout.splitlines()) == wanted, (choice, done.stdout, done.stderr)
        for image, names in holds.items():
            subprocess.run(["sh", "mk/scripts/filters_txt.sh", str(pathlib.Path(image).with_name("filters.txt")), *names], check=True, timeout=600)
        with mock.patch.object(system_support, "SET_IMAGES", list(holds)):
            assert {name: system_support.image_with(name) for name in EVERY} == wanted, choice
            refused(LookupError, lambda: system_support.image_with("kff"), "no image holds the filter kff")
    done = make("--eval", "show: ; @echo $(call image_with,kff)", "show")
    assert done.returncode != 0 and f"no image holds a filter kff; filters: {DEFAULT}" in done.stderr, done.stderr


# --- what does not fit (mk/scripts/link_image.py) ---------------------------------------------------------------------------

FIT = OUT / "fit"
UNO = boards.TABLE["uno"]
ONE_LESS = re.compile(r"leave out (?:one|more than one) of ((?:\w+ \([\d,]+ bytes\)(?:, )?)+)")


def built(filters, *words, **environment):
    """What make did for an image with these filters, and its flash where there is one."""
    elf = FIT / "firmware.elf"
    command = ["make", "--no-print-directory", "-j2", f"U={FIT}", f"FILTERS={filters}", *words, str(elf)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, env={**os.environ, **environment})
    assert (done.returncode == 0) == elf.exists(), done.stderr
    return done, link_image.flash_bytes(elf) if elf.exists() else None


def taken(said):
    """{filter: bytes} of a refusal."""
    return {name: int(bytes_.replace(",", "")) for name, bytes_ in re.findall(r"(\w+) \(([\d,]+) bytes\)", ONE_LESS.search(said)[1])}


@test
def what_is_too_large_says_by_how_much_and_what_fits():
    size = {names: built(names, MEASURE="1")[1] for names in (PLAIN, ROBUST, f"{PLAIN} {ROBUST}")}
    both = size[f"{PLAIN} {ROBUST}"]
    done, _ = built(f"{PLAIN} {ROBUST}", f"BOARD_FLASH={both}")
    assert done.returncode == 0, done.stderr  # to the last byte
    (FIT / "firmware.elf").unlink()
    done, _ = built(f"{PLAIN} {ROBUST}", f"BOARD_FLASH={both - 100}")
    said = [line for line in done.stderr.splitlines() if line.startswith("FILTERS")]
    assert done.returncode != 0 and len(said) == 1 and "region" not in done.stderr, done.stderr
    assert said[0].startswith(f"FILTERS: 100 bytes too many for {UNO.what} ({both:,} where {both - 100:,} fit): leave out one of "), said
    assert taken(said[0]) == {PLAIN: both - size[ROBUST], ROBUST: both - size[PLAIN]} and said[0].endswith(f'; FILTERS="{PLAIN}" fits'), (said, size)
    assert not (FIT / "measured").exists()


@test
def where_one_filter_less_is_not_enough_it_says_how_many_fit():
    """Images whose sizes are made up: 1,000 bytes and these for each filter."""
    bytes_of = dict(zip(EVERY[:5], (500, 400, 300, 200, 100)))
    names = list(bytes_of)
    with mock.patch.object(link_image, "measured", lambda board, names, folder: 1000 + sum(bytes_of[name] for name in names)):
        for flash in range(1000, 2500):
            fit = [names[:count] for count in range(5) if 1000 + sum(list(bytes_of.values())[:count]) <= flash][-1]
            enough = [name for name in names if 2500 - bytes_of[name] <= flash]
            wanted = [name for name in names if name != enough[-1]] if enough else fit
            said = link_image.remedy("uno", flash, names, 2500, FIT)
            assert taken(said) == {name: bytes_of[name] for name in enough or names}, (flash, said)
            assert said.startswith("leave out one of" if enough else "leave out more than one of"), (flash, said)
            assert said.endswith(f'; FILTERS="{" ".join(wanted)}" fits' if wanted else " bytes)"), (flash, said)


def linked_alone(name, source, *words):
    """A C program of one filter, linked by mk/scripts/link_image.py as an image of a Pro Mini."""
    OUT.mkdir(parents=True, exist_ok=True)
    (OUT / f"{name}.c").write_text(source, encoding="ascii")
    command = ["avr-gcc", "-mmcu=atmega328p", "-Os", "-Wl,-T,hal/avr/uno.ld", str(OUT / f"{name}.c"), "-o", str(OUT / f"{name}.elf")]
    return subprocess.run([sys.executable, "mk/scripts/link_image.py", "promini", "30720", PLAIN, *command, *words], capture_output=True, text=True,
                          timeout=600)


LONG = "__attribute__((used, section(\".text.long\"))) static const char one[{0}] = {{1}}, two[{0}] = {{2}};\nint main(void) {{ return 0; }}\n"


@test
def what_the_linker_refuses_is_said_in_the_same_words():
    for bytes_, room in ((31_000, "uno nano"), (40_000, "none")):
        done = linked_alone("long", LONG.format(bytes_ // 2))
        numbers = re.match(r"FILTERS: ([\d,]+) bytes too many .*?\(([\d,]+) where", done.stderr).groups()
        over, size = (int(number.replace(",", "")) for number in numbers)
        assert done.returncode == 1 and size == over + 30_720 and bytes_ < size < bytes_ + 300, done.stderr
        assert f"for {boards.TABLE['promini'].what} (" in done.stderr and not (OUT / "long.elf").exists(), done.stderr
        assert done.stderr.endswith(f": {PLAIN} does not fit even alone; boards with room for it: {room}\n"), done.stderr
        assert done.stderr.count("\n") == 1, done.stderr


@test
def other_faults_of_a_link_stay_as_the_linker_says_them():
    done = linked_alone("missing", "int absent(void);\nint main(void) { return absent(); }\n")
    assert done.returncode == 1 and "undefined reference to `absent'" in done.stderr and "FILTERS" not in done.stderr, done.stderr


# --- the default ------------------------------------------------------------------------------------------------------


def decided():
    """The rule put to the table of the page."""
    scores = {}
    for title, name, group, cell in results.cells(default_filter.PAGE.held()):
        if title == "RMSE by class" and group in score.CLASSES:
            scores.setdefault(group, {})[name.strip("`")] = float(cell.split(" (")[0])
    assert set(scores) == set(score.CLASSES), sorted(scores)
    lacking = set(EVERY) - set.intersection(*map(set, scores.values()))
    assert not lacking, f"docs/results/default-filter.md has no numbers of {sorted(lacking)}: make default writes it"
    return score.verdict(scores)


def default_decided():
    """Where the rule chooses none the default stays what it was."""
    chosen = decided().default
    return score.CANDIDATE if chosen == score.NONE_PASSES else chosen


@test
def every_build_starts_with_what_the_page_decides():
    default = default_decided()
    first = {"lib/filters/src/filter_list.h": EVERY[0], "FILTERS_everyday of mk/images.mk": SETS["everyday"][0],
             "make without FILTERS": chosen_by_make([])[1][0]}
    assert all(name == default for name in first.values()), f"the page decides for {default}, but: {first}"


@test
def the_readme_names_the_default_that_the_page_decides():
    default = default_decided()
    text = pathlib.Path("README.md").read_text(encoding="utf-8")
    named = re.findall(r"`(\w+)` \(default\)", text) + re.findall(r"why `(\w+)` is the default", text)
    assert len(named) >= 2 and set(named) == {default}, (default, named)


@test
def an_image_does_not_depend_on_its_folders_name():
    root = OUT.resolve() / "a folder of a long name"
    shutil.rmtree(root, ignore_errors=True)
    for part in ("firmware", "hal", "lib", "mk"):
        shutil.copytree(part, root / part, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copyfile("Makefile", root / "Makefile")
    done = subprocess.run(["make", "-s", "-j2", EVERYDAY], cwd=root, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    assert (root / EVERYDAY).read_bytes() == pathlib.Path(EVERYDAY).read_bytes()


if __name__ == "__main__":
    raise SystemExit(run_all())
