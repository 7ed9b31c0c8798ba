"""The programs of the PC that judge: each test is linked once against the product as a shared library, and a mutant is a small library
that is loaded before it, so that a mutant costs one object and one link whatever number of tests judge it.
"""
import os
import pathlib
import shlex
import threading

from shop import ROOT, Compiler, Stop, digest, run, timed

# a mutant replaces whole files, so calls within one need not go by the table that lets a library replace them
PLAIN = ["-w", "-O1", "-fPIC", "-fno-semantic-interposition", "-fno-plt"]
# a breach of C's rules ends the program as it does in make test, by a trap: no library to start, nothing to print
VARIANTS = {"ubsan": ["-fsanitize=undefined", "-fsanitize-undefined-trap-on-error"],
            "asan": ["-fsanitize=address,undefined", "-fno-sanitize-recover=all"]}
NOT_OF_THE_PRODUCT = {"test_simrun_judge", "test_wokwi"}  # of the simulator and of its chip for Wokwi
HANG_TIMES, HANG_MIN_S = 10, 1
REFERENCES = ("host_tests/reference/", "nav/tests/reference_")
# Unity's last word on each test function: one that failed has judged the mutant, the others of the program need not run
FIRST_FAILURE = ["-DUNITY_PRINT_EXEC_TIME()=(Unity.TestFailures?_exit(1):(void)0)", "-includeunistd.h"]
# linked into each test: what it starts itself (a shell, python) has no symbols for the libraries that are loaded before the test
ALONE = """int unsetenv(const char *);
__attribute__((constructor)) static void children_load_nothing(void) { unsetenv("LD_PRELOAD"); }
"""


def sources():
    """name -> file of the tests of the PC"""
    return {p.stem: str(p) for pattern in ("host_tests/*/test_*.c", "nav/tests/test_*.c") for p in pathlib.Path(".").glob(pattern)}


class Settings:
    """What make tells: compiler, flags and sources of the PC's programs."""

    def __init__(self, environment=os.environ):
        def words(name):
            if name not in environment:
                raise Stop(f"${name} is not set: run it by make mutants")
            return shlex.split(environment[name])
        self.compiler, self.cxx = words("HOST_CC"), words("HOST_CXX")
        self.flags = [f for f in words("HOST_FLAGS") if f != "-g" and not f.startswith("-O")]
        self.product = words("HOST_SRC")
        names = (pathlib.Path(test).name for test in words("TESTS"))
        self.tests = [name for name in names if not name.startswith("test_nav") and name not in NOT_OF_THE_PRODUCT]
        self.supports = sorted(str(p) for p in pathlib.Path("host_tests/support").glob("*.c"))
        self.references = sorted(str(p) for start in REFERENCES for p in pathlib.Path(".").glob(f"{start}*.cpp"))
        self.unity = f"{environment.get('UNITY_DIR', 'build/unity')}/unity.c"


class Host:
    """The judging programs of one variant."""

    def __init__(self, settings, variant, tree):
        self.settings, self.variant, self.tree = settings, variant, tree
        self.product, self.supports, self.tests = settings.product, settings.supports, settings.tests
        self.flags = VARIANTS[variant]
        self.folder = ROOT / variant
        self.objects = Compiler(variant, self.command, tree)
        self.doubles = Compiler("reference", self.command, tree)  # the same in each variant: a minute of Eigen
        self.library, self.archiving = None, threading.Lock()
        self.programs, self.linking = {}, {}

    def command(self, source):
        if source.endswith(".cpp"):
            includes = [flag for flag in self.settings.flags if not flag.startswith("-std")]
            return [*self.settings.cxx, "-std=c++17", "-O2", "-w", "-fPIC", *includes, "-isystem", "/usr/include/eigen3"]
        unity = FIRST_FAILURE if source == self.settings.unity else []
        return [*self.settings.compiler, *self.settings.flags, *PLAIN, *unity, *self.flags]

    def plain_command(self, source):
        """As the optimiser sees it, without checks of C's rules."""
        return [*(flag for flag in self.command(source) if flag not in self.flags), "-O2"]

    def test_source(self, test):
        return sources()[test]

    def compile(self, pool, tests=()):
        """The product's library, and what the tests are linked from."""
        sources = [*self.product, *self.supports, self.settings.unity, *map(self.test_source, tests)]
        list(pool.map(self.objects.object, sources))
        self.link_product()

    def linked(self, command, target):
        status, said = run(command, self.tree)
        if status != 0:
            why = [line for line in said.splitlines() if "undefined" in line or "error" in line][:1]
            raise Stop(f"{target.name} does not link: {''.join(why) or said[-200:]}")

    def link_product(self):
        """Once, when the first test is linked: the second variant is built for a survivor of the first only."""
        with self.archiving:
            if self.library:
                return
            objects = [self.objects.object(source) for source in self.product]
            library = self.folder / "libproduct.so"
            if not library.exists() or library.stat().st_mtime_ns <= max(o.stat().st_mtime_ns for o in objects):
                self.linked([*self.settings.cxx, "-shared", *self.link_flags(), *objects, "-lm", "-o", library], library)
            self.library = [library]

    def mutant_library(self, changed, out):
        """A library of a mutant's objects, by source, that goes before the product's; None where it does not link."""
        target = out / "mutant.so"
        return [target] if run(["ld", "-shared", *changed.values(), "-o", target], self.tree)[0] == 0 else None

    def link_flags(self):
        return ["-fsanitize=address,undefined"] if self.variant == "asan" else ["-fsanitize=undefined"]

    def references(self, test):
        """The double references that a test asks for: those that make test built, if they are at hand, else compiled here."""
        sources = [self.test_source(test), *self.supports]
        if not any(name.startswith(REFERENCES) for source in sources for name in self.objects.deps(source)):
            return []
        found = []
        for source in self.settings.references:
            built = pathlib.Path("build/host", source).with_suffix(".o")
            newest = max(p.stat().st_mtime for p in [pathlib.Path(source), *pathlib.Path(source).parent.glob("*.h*")])
            found.append(built.resolve() if built.exists() and built.stat().st_mtime > newest else self.doubles.object(source))
        archive = self.folder / "libreference.a"
        with self.archiving:
            if not archive.exists() or archive.stat().st_mtime_ns < max(o.stat().st_mtime_ns for o in found):
                archive.unlink(missing_ok=True)
                self.linked(["ar", "rcs", archive, *found], archive)
        return [archive]

    def alone(self):
        """The object of ALONE."""
        target = self.folder / "alone.o"
        with self.archiving:
            if not target.exists():
                target.with_suffix(".c").write_text(ALONE, encoding="ascii")
                self.linked([*self.settings.compiler, *PLAIN, "-c", target.with_suffix(".c"), "-o", target], target)
        return target

    def program(self, test):
        """The test's program, linked when it is first asked for."""
        with self.objects.guard:
            lock = self.linking.setdefault(test, threading.Lock())
        with lock:
            if test not in self.programs:
                self.programs[test] = self.link_test(test, self.folder / f"{test}.exe", {})
        return self.programs[test]

    def link_test(self, test, target, instead):
        """`instead`: objects of a mutant in place of unbroken ones, by source."""
        self.link_product()
        sources = [self.test_source(test), *self.supports, self.settings.unity]
        objects = [instead.get(source, self.objects.object(source)) for source in sources]
        inputs = [*objects, self.alone(), *self.references(test), *self.library]
        if instead or not target.exists() or target.stat().st_mtime_ns <= max(p.stat().st_mtime_ns for p in inputs):
            self.linked([*self.settings.cxx, *self.link_flags(), *inputs, f"-Wl,-rpath,{self.folder}", "-lm", "-o", target], target)
        return target

    def preload(self, libraries):
        first = [self.runtime()] if self.variant == "asan" else []
        return {"LD_PRELOAD": " ".join(map(str, [*first, *libraries]))} if libraries else {}

    def runtime(self):
        return run([*self.settings.compiler, "-print-file-name=libasan.so"], self.tree)[1].strip()

    def signature(self, test):
        """Changes when anything changes that a run of the unbroken test depends on."""
        sources = [*self.product, *self.supports, self.test_source(test)]
        return digest(self.variant, *(sorted(self.objects.deps(source).items()) for source in sources))

    def run_test(self, test, tree, libraries=(), limit_s=600, program=None, **environment):
        """(passes, seconds of the processor)"""
        status, seconds = timed([program or self.program(test)], tree, limit_s, **self.preload(libraries), **environment)
        return status == 0, seconds
