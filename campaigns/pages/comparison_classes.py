"""The class table that decides the default filter, for the compared filters: from build/default.json (make default), and Fusion in a run of its own
over the same streams with fewer seeds."""
import dataclasses
import json
import pathlib

import default_filter
import default_score as score
import default_streams as streams
from comparison_filters import FUSION, NAMES, OF_PAPER
from results import Fault, output_of

JSON = pathlib.Path("build/default.json")
PROGRAM = pathlib.Path("build/host/default_filter_fusion")


@dataclasses.dataclass
class FewSeeds(streams.Job):
    """The least that the class table takes of each fault."""

    def seeds(self):
        return min(super().seeds(), streams.SEEDS_MIN)

    def outlier_seeds(self):
        return min(super().outlier_seeds(), 1)


def of_json():
    """{class: {filter: LSB}}, whether the recordings are in it, and the same of the recordings alone for what is of the paper."""
    try:
        rows = json.loads(JSON.read_text(encoding="ascii"))
    except (OSError, ValueError) as problem:
        raise Fault(f"{JSON}: cannot be read: {problem}; make default writes it") from problem
    found = {}
    for row in rows:
        if row["level"] == "class":
            found.setdefault(row["class"], {})[row["filter"]] = row["rmse_lsb"]
    missing = [name for name in (*NAMES, *OF_PAPER, *OF_PAPER.values()) if any(name not in scores for scores in found.values())]
    if missing or not found:
        raise Fault(f"{JSON}: has no {', '.join(missing) or 'class'}: make default writes it anew")
    return found, rows[0]["recordings"], of_recordings(rows)


def of_recordings(rows):
    """{class: {filter: LSB}}: mean over the rates of the mean over their recordings of ln(RMSE), as score.log_score."""
    rates = {}
    for row in rows:
        if row["level"] == "stream" and not row["made"] and row["class"] in streams.CLASSES:
            of_filter = rates.setdefault(row["class"], {}).setdefault(row["filter"], {})
            of_filter.setdefault(row["rate_hz"], []).append(max(row["rmse_lsb_5Hz"], score.LEAST_LSB))
    return {group: {name: score.geometric_mean(map(score.geometric_mean, found[name].values())) for name in found} for group, found in rates.items()}


def of_fusion(recordings):
    """{class: LSB}; direction times 1 g, so that forces beside gravity count as its error."""
    if not PROGRAM.is_file():
        return {}
    default_filter.make_streams()
    jobs = streams.scenario_jobs() + (streams.recording_jobs(streams.recordings_index()) if recordings else [])
    jobs = [FewSeeds(**vars(job)) for job in jobs if not job.source.tuning]
    text = "".join(output_of([PROGRAM, FUSION], "".join(job.line() + "\n" for job in jobs[i:i + 8])) for i in range(0, len(jobs), 8))
    cells = score.cells_of(jobs, score.read_rows(text))
    return {group: found[FUSION] for group, found in score.by_class(cells, (FUSION,)).items()}


def measured():
    """({class: {filter: LSB}} with Fusion where it is built, whether the recordings are in it, the recordings alone)"""
    found, recordings, recorded = of_json()
    for group, value in of_fusion(recordings).items():
        found[group][FUSION] = value
    return found, recordings, recorded
