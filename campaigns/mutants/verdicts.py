"""What is known of each mutant: kept while it lasts, so that a campaign goes on where it stopped; the accepted survivors; the tables."""
import json
import math
import pathlib
import re
import threading
from collections import Counter

from shop import ROOT, digest

ACCEPTED = pathlib.Path("campaigns/mutants/accepted.txt")
GOALS = pathlib.Path("campaigns/mutants/goals.txt")
HEAD = """# Mutants that no test notices, written by `make mutants`: file:function, operator, what became what, which of its kind in the
# function. CI judges its sample by this list (goals.txt). A line leaves the list when a test kills its mutant.
"""


GOALS_HEAD = """# Folders, the least kill rate of each (0: only measured), its rate at the last whole measurement (`make mutants ONLY=folder ACCEPT=1`
# writes it), and a digest of its sources then. A sample is drawn from folders that have a goal or have not changed since. Where nothing
# has changed, every survivor that is not accepted fails. Where something has, the new survivors are not known: the sample, in which no
# accepted one is, fails when more survive than the goal leaves beside the accepted ones (by chance in one sample of a hundred).
# folder            goal %  rate %  sources
"""
CHANCE = 0.01


def source_of(judge):
    """The file of a judging test: test_rest, or system:WORD with part of the name of a test of the chip; None where there is none."""
    word = judge.removeprefix("system:")
    if word == judge:
        return next((p for folder in ("host_tests", "nav") for p in pathlib.Path(folder).glob(f"*/{judge}.c")), None)
    named = re.compile(rf"^def \w*{re.escape(word)}", re.MULTILINE)
    return next((p for p in sorted(pathlib.Path("host_tests/system").glob("system_*.py")) if named.search(p.read_text(encoding="utf-8"))), None)


class Results:
    """Lines of build/mutants/results.jsonl. A kill holds while the mutant's file and the test that noticed it are the same, a survival
    while nothing changes that the product or a test is made of."""

    def __init__(self, everything):
        self.path, self.everything, self.guard = ROOT / "results.jsonl", everything, threading.Lock()
        self.known, self.judges = {}, {}
        self.path.parent.mkdir(parents=True, exist_ok=True)
        if self.path.exists():
            for line in self.path.read_text(encoding="utf-8").splitlines():
                try:
                    row = json.loads(line)
                except ValueError:  # the last line of a killed run
                    continue
                self.known[row["key"]] = row

    def judge_hash(self, judge):
        if judge not in self.judges:
            source = source_of(judge)
            self.judges[judge] = digest(source.read_bytes()) if source else ""
        return self.judges[judge]

    def get(self, mutant, source_hash):
        row = self.known.get(mutant.key)
        if row is None or row["source"] != source_hash or (row["verdict"] == "survived" and row["all"] != self.everything):
            return None
        now = self.judge_hash(row["by"])
        return row if row.get("judge", now) == now else None  # a row without a hash is believed

    def put(self, mutant, source_hash, line, verdict, by, seconds, keep=True):
        row = {"key": mutant.key, "file": mutant.file, "function": mutant.owner, "operator": mutant.operator, "line": line, "verdict": verdict,
               "by": by, "seconds": round(seconds, 2), "source": source_hash, "all": self.everything, "judge": self.judge_hash(by)}
        if not keep:
            return row
        with self.guard:
            self.known[mutant.key] = row
            with self.path.open("a", encoding="utf-8") as out:
                out.write(json.dumps(row) + "\n")
        return row


def accepted():
    if not ACCEPTED.exists():
        return set()
    return {line for line in ACCEPTED.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")}


def write_accepted(rows, files):
    """The survivors of these files, of whose mutants all have a verdict, replace those that were known of them."""
    kept = {key for key in accepted() if key.split(":", 1)[0] not in files and pathlib.Path(key.split(":", 1)[0]).exists()}
    kept |= {row["key"] for row in rows if row["verdict"] == "survived"}
    ACCEPTED.write_text(HEAD + "".join(f"{key}\n" for key in sorted(kept)), encoding="utf-8")


def folder_of(file):
    parts = pathlib.Path(file).parts
    return "/".join(parts[:2]) if parts[0] in ("lib", "hal", "nav") and len(parts) > 2 else parts[0]


def table(rows, of, title):
    counts = {}
    for row in rows:
        counts.setdefault(of(row), Counter())[row["verdict"]] += 1
    lines = [f"{title:<40}{'mutants':>8}{'dropped':>8}{'judged':>8}{'killed':>8}{'survived':>9}{'rate':>8}"]
    for name, count in sorted(counts.items()):
        dropped, judged = count["uncompiled"] + count["same"], count["killed"] + count["survived"]
        rate = f"{100 * count['killed'] / judged:.1f} %" if judged else "-"
        lines.append(f"{name:<40}{sum(count.values()):>8}{dropped:>8}{judged:>8}{count['killed']:>8}{count['survived']:>9}{rate:>8}")
    return "\n".join(lines)


def write_json(rows):
    pathlib.Path("build/mutants.json").write_text(json.dumps(sorted(rows, key=lambda r: (r["file"], r["line"])), indent=0), encoding="utf-8")


def goals():
    """folder -> (least share of its mutants that tests must notice, share at its last whole measurement or None), in per cent."""
    rows = [line.split() for line in GOALS.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    return {row[0]: (float(row[1]), None if row[2] == "-" else float(row[2])) for row in rows}


def sources_measured():
    """folder -> digest of its sources at its last whole measurement, where it is known."""
    rows = [line.split() for line in GOALS.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    return {row[0]: row[3] for row in rows if len(row) > 3}


def measured(digests):
    """The folders whose accepted survivors are all known: their sources have these digests still."""
    return [folder for folder, known in sources_measured().items() if digests.get(folder) == known]


def sampled(digests):
    """The folders that a sample may be drawn from."""
    unchanged = measured(digests)
    return [folder for folder, (goal, _) in goals().items() if goal > 0 or folder in unchanged]


def rates(rows):
    """folder -> (killed, judged)"""
    found = {}
    for row in rows:
        if row["verdict"] in ("killed", "survived"):
            killed, judged = found.get(folder_of(row["file"]), (0, 0))
            found[folder_of(row["file"])] = killed + (row["verdict"] == "killed"), judged + 1
    return found


def below_goal(rows, folders):
    """Of these folders, which were measured whole."""
    found = []
    for folder, (killed, judged) in rates(rows).items():
        goal = goals().get(folder, (0, None))[0]
        if folder in folders and 100 * killed < goal * judged:
            found.append(f"{folder}: {killed} of {judged} killed, below the goal of {goal:g} %")
    return found


def at_least(survived, judged, share):
    """The chance that so many or more of the judged survive where this share of all does."""
    return sum(math.comb(judged, n) * share ** n * (1 - share) ** (judged - n) for n in range(survived, judged + 1))


def may_survive(mutants, known):
    """folder -> the share of its mutants that are not accepted that may survive while its goal is met."""
    shares = {}
    for folder in {folder_of(mutant.file) for mutant in mutants}:
        keys = {mutant.key for mutant in mutants if folder_of(mutant.file) == folder}
        spare = (1 - goals().get(folder, (0, None))[0] / 100) * len(keys) - len(keys & known)
        shares[folder] = max(0.0, spare) / max(1, len(keys - known))
    return shares


def missed_by_sample(rows, folders, shares):
    """Of these folders, of which a sample was judged; shares: may_survive's."""
    found = []
    for folder, (killed, judged) in rates(rows).items():
        if folder in folders and at_least(judged - killed, judged, shares[folder]) < CHANCE:
            found.append(f"{folder}: {judged - killed} of {judged} survive, too many where the goal leaves {100 * shares[folder]:.1f} %")
    return found


def write_goals(rows, folders, digests):
    """The rates of these folders, which were measured whole, beside their goals."""
    table_, sources = goals(), sources_measured()
    sources.update({folder: digests[folder] for folder in rates(rows) if folder in folders})
    for folder, (killed, judged) in rates(rows).items():
        if folder in folders:
            table_[folder] = table_.get(folder, (0.0, None))[0], 100 * killed / judged
    lines = [f"{folder:<20}{goal:>6g}{'-' if rate is None else f'{rate:.1f}':>8}  {sources.get(folder, '')}".rstrip() + "\n"
             for folder, (goal, rate) in sorted(table_.items())]
    GOALS.write_text(GOALS_HEAD + "".join(lines), encoding="utf-8")
