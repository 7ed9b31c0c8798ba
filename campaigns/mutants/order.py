"""Which tests judge a mutant, and in which order."""
import pathlib
from collections import Counter

import test_parts
from operators import mutants_of
from reach import Reach

JUDGES = pathlib.Path("campaigns/mutants/judges.txt")
HEAD = "# The tests that notice most of a file's mutants, by `make mutants ACCEPT=1`: a sample asks these first.\n"
KEPT = 12  # names a file
START_S, REBUILD_S = 0.02, 0.2


def listed():
    """file -> tests"""
    if not JUDGES.exists():
        return {}
    rows = [line.split(": ", 1) for line in JUDGES.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    return {file: names.split() for file, names in rows}


class Reached:
    """Those that reach the mutant's line: first what costs least for each mutant of its file that it is likely to notice."""

    def __init__(self, host, mutants, texts, patience_s, pool, say):
        files = {m.file for m in mutants}
        units = [s for s in host.product if s in files or files & set(host.objects.deps(s))]
        self.host, self.texts, self.patience_s, self.kills = host, texts, patience_s or float("inf"), Counter()
        self.asked = Counter()
        self.reach = Reach(host, units)
        self.reach.measure(pool, host.tests, self.patience_s, say)
        self.limits = {(host.variant, test): seconds for test, seconds in self.reach.seconds.items()}
        self.spans = {}
        for name in files:
            for mutant in mutants_of(name, texts[name]):
                self.spans.setdefault((name, mutant.owner), set()).add(mutant.line(texts[name]))

    def tests(self, mutant, _host):
        line, span = mutant.line(self.texts[mutant.file]), self.spans[mutant.file, mutant.owner]
        includers = [s for s in self.reach.files if mutant.file in self.host.objects.deps(s)] if mutant.file.endswith(".h") else []
        found = self.reach.tests_of(mutant.file, line, span, includers)
        return sorted(found, key=lambda test: self.cost_s(mutant, test) / self.likely(mutant.file, test))

    def cost_s(self, mutant, test):
        """A test that includes the mutant's header is compiled and linked for it."""
        rebuilt = mutant.file.endswith(".h") and mutant.file in self.host.objects.deps(self.host.test_source(test))
        return self.reach.seconds[test] + START_S + (REBUILD_S if rebuilt else 0)

    def likely(self, file, test):
        return (1 + self.kills[file, test]) / (2 + self.asked[file, test])

    def learn(self, mutant, by):
        for test in self.tests(mutant, self.host):
            self.asked[mutant.file, test] += 1
            if test == by:
                self.kills[mutant.file, by] += 1
                return


class Cheapest:
    """All of a host's few tests, by what they took; before that is known, those first that noticed most in the last campaign."""

    def __init__(self, patience_s):
        self.limits, self.kills, self.patience_s, self.first = {}, Counter(), patience_s or float("inf"), listed()

    def tests(self, mutant, host):
        first = self.first.get(mutant.file, [])
        guess_s = {test: 0 if test in first else 1 for test in host.tests}
        seconds = {test: self.limits.get((host.variant, test), guess_s[test]) for test in host.tests}
        found = [test for test in host.tests if seconds[test] <= self.patience_s]
        return sorted(found, key=lambda test: seconds[test] / (1 + self.kills[mutant.file, test]))

    def learn(self, mutant, by):
        if by:
            self.kills[mutant.file, by] += 1


class Listed:
    """Without a measurement: those that noticed most in the file's last whole campaign, then all others that are linked with the file."""

    def __init__(self, tests, source_of):
        self.all, self.limits, known = tests, {}, test_parts.headers()
        self.linked = {test: {str(path) for path in test_parts.of(source_of(test), known).seen} for test in tests}
        self.first = {file: [name for name in names if name in tests] for file, names in listed().items()}

    def tests(self, mutant, _host):
        first = self.first.get(mutant.file, [])
        linked = [test for test in self.all if mutant.file in self.linked[test]] or self.all
        rest = [test for test in linked if test not in first]
        return first + sorted(rest, key=lambda test: test.endswith("_reference"))  # these need Eigen's minute of compiling

    def learn(self, mutant, by):
        pass


def write_judges(rows):
    kills = {}
    for row in rows:
        if row["by"]:
            kills.setdefault(row["file"], Counter())[row["by"]] += 1
    known = {file: " ".join(names) for file, names in listed().items()}
    known |= {file: " ".join(name for name, _ in count.most_common(KEPT)) for file, count in kills.items()}
    JUDGES.write_text(HEAD + "".join(f"{file}: {known[file]}\n" for file in sorted(known) if pathlib.Path(file).exists()), encoding="utf-8")
