"""The experiments of papers 000 and 001 by name, with their relative work."""
import papers_program

from . import counted, paper_000, paper_001
from .batch import Refused
from .streams import roll_as_angle
from .table1 import table1_search

PAPERS = {"000": {"all_filters": (10, paper_000.all_filters), "adaptive": (6, paper_000.adaptive), "noise": (1, paper_000.noise),
                  "roll_reference": (1, paper_000.reference_table), "table1_search": (3, table1_search), "schedules": (2, paper_000.schedules),
                  "equal_noise": (1, paper_000.equal_noise), "roll_as_angle": (1, roll_as_angle),
                  "complexity": (0.1, lambda _options: counted.rows("complexity", counted.STEPS))},
          "001": {"altitude": (3, paper_001.readings), "altitude_shipped": (3, paper_001.shipped_filters), "ratios": (0.1, paper_001.ratios)}}


def main(words):
    """The first word is the paper."""
    paper = words[0] if words and words[0] in PAPERS else "000"
    return papers_program.main(f"synthesis {paper}", PAPERS[paper], words[words[:1] == [paper]:], Refused)
