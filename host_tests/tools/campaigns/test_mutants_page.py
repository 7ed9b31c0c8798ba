"""docs/results/mutants.md: which mutants of a campaign it counts and how, in which order they are judged, and which campaigns write it."""
import importlib.util
import pathlib
import sys
import types

CAMPAIGN = pathlib.Path("campaigns/mutants/__main__.py")
sys.path[:0] = [*pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split(), str(CAMPAIGN.parent)]
import page_mutants  # noqa: E402
from operators import mutants_of  # noqa: E402
from order import Listed  # noqa: E402
from system_support import OUT, refused, run_all, test  # noqa: E402


def campaign_module():
    spec = importlib.util.spec_from_file_location("campaign", CAMPAIGN)
    campaign = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(campaign)
    return campaign


def of_folder(folder, verdicts, every):
    """(mutants, rows) of a folder of so many mutants, of which the first have these verdicts: k killed, s survived, d dropped, - none yet."""
    words = {"k": "killed", "s": "survived", "d": "same"}
    made = [types.SimpleNamespace(file=f"{folder}/a.c", key=f"{folder}/a.c:f relational | -> & #{n}") for n in range(every)]
    return made, [{"key": mutant.key, "file": mutant.file, "function": "f", "operator": "relational", "line": n, "verdict": words[verdict]}
                  for n, (mutant, verdict) in enumerate(zip(made, verdicts)) if verdict != "-"]


@test
def a_page_counts_those_drawn_and_weights_folders_by_their_mutants():
    """Of lib/a 10 of 100 are drawn, 8 judged, 6 killed; of hal/b all 8, 2 killed: 60 + 2 of 80 + 4. A kill after one without a verdict, and
    nav, count for nothing in the sum."""
    folders = [of_folder("lib/a", "kkkkkkssdd-k", 100), of_folder("hal/b", "kkssdddd", 8), of_folder("nav/c", "ss", 2), of_folder("lib/e", "-", 5)]
    made, rows = ([item for folder in folders for item in folder[part]] for part in (0, 1))
    lines = page_mutants.tables(made, rows, lambda file: str(pathlib.Path(file).parent), {"hal/b/a.c:f relational | -> & #2": "they are equal"})
    cells = [[cell.strip() for cell in line.strip("|").split(" | ")] for line in lines if line.startswith("| ")]
    found = {row[0]: row[1:] for row in cells}
    assert found["lib/a"][:7] == ["100", "10", "0", "2", "6", "2", "75.0"] and found["hal/b"] == ["8", "8", "0", "4", "2", "2", "50.0", "0.0"], found
    assert found["lib/e"] == ["5", "0", "0", "0", "0", "0", "-", "-"] and found["nav/c"][6] == "0.0", found
    assert found["lib, firmware, hal"][:7] == ["113", "18", "0", "6", "8", "4", f"{100 * 62 / 84:.1f}"], found
    # (6 + 2) / (8 + 4) killed, as Agresti and Coull have it, of a tenth of the folder
    assert float(found["lib/a"][7]) == round(200 * (2 / 3 * 1 / 3 / 12 * 0.9) ** 0.5, 1), found
    assert found["`hal/b/a.c:2`"] == ["`f`", "relational", "`\\| -> & #2`", "they are equal"] and len(cells) == 2 + 5 + 6, cells


@test
def every_committed_reason_is_of_a_mutant_of_this_tree():
    files = {line.partition(":")[0] for line in page_mutants.EQUAL.read_text(encoding="utf-8").splitlines() if not line.startswith("#")}
    keys = {mutant.key for file in files for mutant in mutants_of(file, pathlib.Path(file).read_text(encoding="utf-8"))}
    assert len(page_mutants.reasons(keys)) > 1


@test
def a_reason_is_of_a_mutant_that_there_is():
    page_mutants.EQUAL = OUT / "equal.txt"
    page_mutants.EQUAL.write_text("# key | why\nlib/a.c:f logical | -> & #1 | both are 0\n", encoding="utf-8")
    assert page_mutants.reasons({"lib/a.c:f logical | -> & #1"}) == {"lib/a.c:f logical | -> & #1": "both are 0"}
    refused(page_mutants.Fault, lambda: page_mutants.reasons({"lib/a.c:g logical | -> & #1"}), "f logical | -> & #1 is no mutant")


@test
def a_folder_is_judged_in_one_order_whatever_else_is_and_the_navigation_filter_last():
    campaign = campaign_module()
    every = [types.SimpleNamespace(file=file, key=f"{file}:{n}") for file in ("nav/lib/a.c", "lib/b.c", "hal/c.c") for n in range(50)]
    drawn = campaign.chosen(every, set(), campaign.options_of([]))
    assert [m.file for m in drawn[100:]] == ["nav/lib/a.c"] * 50 and sorted(m.key for m in drawn) == sorted(m.key for m in every)
    assert 10 <= sum(m.file == "lib/b.c" for m in drawn[:50]) <= 40 and drawn[:100] != sorted(drawn[:100], key=lambda m: m.key)
    alone = campaign.chosen([m for m in every if m.file == "hal/c.c"], set(), campaign.options_of([]))
    assert alone == [m for m in drawn if m.file == "hal/c.c"]


@test
def only_a_campaign_over_all_by_all_tests_has_a_page():
    campaign = campaign_module()
    for words, page in (([], True), (["--seconds=9"], True), (["--only=lib"], False), (["--sample=9"], False), (["--patience=9"], False)):
        assert campaign.has_page(campaign.options_of(words)) == page, words


@test
def a_sample_asks_the_tests_that_are_linked_with_the_file_and_first_those_that_noticed_most():
    places = {"test_driver": "host_tests/adxl345/test_driver.c", "test_sprf": "host_tests/filters/test_sprf.c",
              "test_app": "host_tests/firmware/test_app.c"}
    listed = Listed(list(places), places.get)
    driver, header = "lib/adxl345/src/adxl345_driver.c", "lib/adxl345/src/i2c_bus.h"
    listed.first = {driver: ["test_sprf"]}
    asked = [listed.tests(types.SimpleNamespace(file=file), None) for file in (driver, header)]
    assert asked == [["test_sprf", "test_driver", "test_app"], ["test_driver", "test_app"]], asked
    assert listed.tests(types.SimpleNamespace(file="unknown.h"), None) == list(places)


if __name__ == "__main__":
    sys.exit(run_all())
