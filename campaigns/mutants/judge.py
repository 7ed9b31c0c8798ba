"""One mutant of portable C, from its text to a verdict: uncompiled, same (no other machine code), killed (by whom) or survived."""
import shutil
import threading

from host import HANG_MIN_S, HANG_TIMES
from shop import ROOT, Stop, plain, run

DOUBTFUL = 5  # after so many tests that notice nothing it is asked whether there is anything to notice


class Worker:
    """A copy of the tree that one mutant at a time is written into."""

    def __init__(self, number, tree):
        self.tree, self.out = tree, ROOT / f"out{number}"
        shutil.rmtree(self.out, ignore_errors=True)
        self.out.mkdir(parents=True)


class Same(Exception):
    """The optimiser sees no difference."""


class Judge:
    """order(mutant, host) -> tests, cheapest first, that are to judge it; hosts: the first that notices it ends it."""

    def __init__(self, hosts, order, limits):
        self.hosts, self.order, self.limits = hosts, order, limits
        self.guard = threading.Lock()
        self.checked = {}  # (variant, test) -> lock of its unbroken run
        self.plain = {}  # source -> its unbroken object as the optimiser makes it

    def units(self, host, file):
        sources = [*host.product, *host.supports]
        return [s for s in sources if plain(s) == file or (file.endswith(".h") and file in host.objects.deps(s))]

    def verdict(self, mutant, worker):
        """(verdict, by)"""
        path = worker.tree / mutant.file
        whole = path.read_text(encoding="utf-8")
        path.write_text(mutant.apply(whole), encoding="utf-8")
        try:
            for host in self.hosts:
                verdict, by = self.on(host, mutant, worker, host is self.hosts[0])
                if verdict != "survived":
                    return verdict, by
            return "survived", ""
        except Same:
            return "same", ""
        finally:
            path.write_text(whole, encoding="utf-8")

    def on(self, host, mutant, worker, first):
        changed = {}
        for source in self.units(host, mutant.file):
            target = worker.out / f"{source.replace('/', '__')}.o"
            code = host.objects.broken(worker.tree, source, target)
            if code is None:
                return "uncompiled", ""
            if code != host.objects.object(source).read_bytes():
                changed[source] = target
        if not changed:
            return "same", ""
        product = {source: target for source, target in changed.items() if source in host.product}
        supports = {source: target for source, target in changed.items() if source not in host.product}
        libraries = host.mutant_library(product, worker.out) if product else ()
        if libraries is None:
            return "uncompiled", ""
        by = self.tests(host, mutant, worker, libraries, supports, first)
        return ("killed", by) if by else ("survived", "")

    def tests(self, host, mutant, worker, libraries, supports, first):
        """The first test that fails."""
        tests = self.order(mutant, host)
        if host.variant == "asan":  # a bad access shows in whichever test makes it, and what else they judge is judged
            tests = tests[:DOUBTFUL]
        for number, test in enumerate(tests, 1):
            limit_s = self.limit_of(host, test)
            program = None
            instead = dict(supports)
            source = host.test_source(test)
            if mutant.file.endswith(".h") and mutant.file in host.objects.deps(source):
                instead[source] = worker.out / "test.o"
                if host.objects.broken(worker.tree, source, instead[source]) is None:
                    return test
            if instead:
                program = host.link_test(test, worker.out / "test.exe", instead)
            if not host.run_test(test, worker.tree, libraries, limit_s, program)[0]:
                return test
            if first and number == DOUBTFUL < len(tests):
                self.doubt(host, mutant, worker)
        if first and len(tests) <= DOUBTFUL:
            self.doubt(host, mutant, worker)
        return None

    def doubt(self, host, mutant, worker):
        if self.same_optimised(host, mutant, worker):
            raise Same

    def limit_of(self, host, test):
        """Ten times what the unbroken test takes: of the processor's time."""
        key = host.variant, test
        with self.guard:
            lock = self.checked.setdefault(key, threading.Lock())
        with lock:
            if key not in self.limits:
                passes, seconds = host.run_test(test, host.tree)
                if not passes:
                    raise Stop(f"{test} ({host.variant}) fails or hangs on the unbroken code: make t T={test.removeprefix('test_')}")
                self.limits[key] = seconds
        return max(HANG_MIN_S, HANG_TIMES * self.limits[key])

    def same_optimised(self, host, mutant, worker):
        """Whether the optimiser, without the checks of C's rules, sees no difference: what only moves such a check is no mutant."""
        for source in self.units(host, mutant.file):
            command = [*host.plain_command(source), "-c", plain(source), "-o"]
            target = worker.out / "optimised.o"
            with self.guard:
                if source not in self.plain:
                    whole = host.folder / f"optimised-{source.replace('/', '__')}.o"
                    run([*command, whole], host.tree)
                    self.plain[source] = whole.read_bytes()
            if run([*command, target], worker.tree, CCACHE_DISABLE="1")[0] != 0 or target.read_bytes() != self.plain[source]:
                return False
        return True
