"""Which test reaches which line, by gcov: the files asked for are compiled with its counters into a library that is loaded before the
product's own, and each test is run once. Kept in build/mutants/reach, by the hash of all that a test is made of.
"""
import json
import shutil

from shop import ROOT, Compiler, Stop, digest, run

FOLDER = ROOT / "reach"


class Reach:
    def __init__(self, host, files):
        """files: the product's sources (.c) whose lines are asked for."""
        self.host, self.files = host, sorted(files)
        flags = [f for f in host.command("x.c") if not f.startswith(("-fsanitize", "-fno-sanitize", "-O"))]
        self.objects = Compiler("reach/objects", lambda _: [*flags, "-O0", "--coverage"], host.tree)
        self.lines, self.seconds = {}, {}  # test -> file -> lines that it runs; test -> seconds
        self.known = {}  # file -> lines that can run

    def measure(self, pool, tests, patience_s, say):
        """Tests that took longer than patience_s when they last ran are left out."""
        if not self.files:
            return
        tests = [test for test in tests if self.last_s(test) <= patience_s]
        objects = list(pool.map(self.objects.object, self.files))
        self.library = FOLDER / "libreach.so"
        self.host.linked([*self.host.settings.cxx, "-shared", "--coverage", *objects, "-lm", "-o", self.library], self.library)
        for number, (test, answer) in enumerate(zip(tests, pool.map(self.of_test, tests)), 1):
            self.seconds[test] = answer["seconds"]
            self.lines[test] = {}
            for file, (hit, all_lines) in answer["files"].items():
                self.lines[test][file] = set(hit)
                self.known.setdefault(file, set()).update(all_lines)
            if number % 10 == 0 or number == len(tests):
                say(f"reach: {number} of {len(tests)} tests")

    @staticmethod
    def last_s(test):
        kept = [json.loads(path.read_text(encoding="utf-8"))["seconds"] for path in FOLDER.glob(f"{test}-*.json")]
        return min(kept, default=0)

    def of_test(self, test):
        kept = FOLDER / f"{test}-{digest(self.host.signature(test), self.files)}.json"
        if not kept.exists():
            for old in FOLDER.glob(f"{test}-*.json"):
                if len(list(FOLDER.glob(f"{test}-*.json"))) > 12:  # other choices of files are worth keeping, all history is not
                    old.unlink()
            kept.write_text(json.dumps(self.run(test)), encoding="utf-8")
        return json.loads(kept.read_text(encoding="utf-8"))

    def run(self, test):
        folder = FOLDER / f"run-{test}"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        passes, seconds = self.host.run_test(test, self.host.tree, [self.library], GCOV_PREFIX=str(folder), GCOV_PREFIX_STRIP="99")
        if not passes:
            raise Stop(f"{test} fails or hangs on the unbroken code: make t T={test.removeprefix('test_')}")
        files = {}
        counters = sorted(folder.rglob("*.gcda"))
        for counter in counters:
            note = self.objects.folder / f"{counter.stem}.gcno"
            shutil.copy(note, counter.with_suffix(".gcno"))
        if counters:
            said = run(["gcov", "--json-format", "--stdout", *(c.name for c in counters)], counters[0].parent)[1]
            for line in said.splitlines():
                if line.startswith("{"):
                    self.add(files, json.loads(line))
        shutil.rmtree(folder)
        return {"seconds": seconds, "files": {file: [sorted(hit), sorted(known)] for file, (hit, known) in files.items()}}

    @staticmethod
    def add(files, answer):
        for entry in answer["files"]:
            if entry["file"].startswith("/"):
                continue
            hit, known = files.setdefault(entry["file"], (set(), set()))
            for line in entry["lines"]:
                known.add(line["line_number"])
                if line["count"]:
                    hit.add(line["line_number"])

    def tests_of(self, file, line, span, includers):
        """The tests that run the line; where it is none of the machine's, those that run its function, else its file."""
        for wanted in ({line}, span):
            if wanted & self.known.get(file, set()):
                return [t for t in self.lines if wanted & self.lines[t].get(file, set())]
        files = {file, *includers}
        return [t for t in self.lines if any(self.lines[t].get(f) for f in files)]
