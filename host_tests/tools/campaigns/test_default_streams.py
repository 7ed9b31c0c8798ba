"""make default: which stream is in which class and half, at which rates, and recordings that cannot be read."""
import os
import pathlib
import re
import sys
from unittest import mock

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import default_streams as streams  # noqa: E402
import make_streams
import recordings
import results
from results import Fault

from system_support import refused, run_all, test

OUT = pathlib.Path("build/default-test")


@test
def every_class_has_a_stream_at_every_rate_without_the_recordings():
    found = {(job.source.motion, job.rate_hz) for job in streams.scenario_jobs()}
    groups = (*streams.MOTIONS, streams.BAD_READS, streams.OUTLIERS)  # bursts are put in
    missing = [(group, rate_hz) for group in groups for rate_hz in streams.RATES_HZ if (group, rate_hz) not in found]
    assert missing == [] and streams.RATES_HZ == (25, 50, 100, 200, 400, 800), missing


@test
def every_stream_is_in_a_class_or_left_out_with_a_reason():
    shipped = {scenario.name for scenario in make_streams.SCENARIOS}
    assert shipped == ({s.name for s in streams.SCENARIOS} - {"walk-model"}) | (set(streams.LEFT_OUT) & shipped)
    text = recordings.DOCUMENT.read_text(encoding="utf-8")
    recorded = {name for title, name, _, _ in results.cells(text) if title == "The recordings"}
    assert len(recorded) >= 33 and recorded == {s.name for s in streams.RECORDINGS} | (set(streams.LEFT_OUT) - shipped)
    sources = (*streams.SCENARIOS, *streams.RECORDINGS)
    assert all(s.motion in streams.CLASSES and s.why for s in sources) and all(streams.LEFT_OUT.values())


@test
def each_half_of_the_recordings_has_every_motion_and_no_session_of_the_other():
    halves = {half: [source for source in streams.RECORDINGS if source.tuning == half] for half in (True, False)}
    assert all({source.motion for source in half} == set(streams.MOTIONS) for half in halves.values())
    assert streams.TUNING == {source.name for source in halves[True]} and len(streams.TUNING) <= len({s.name for s in streams.RECORDINGS}) / 2 + 1
    sessions = {half: {re.sub("-.*", "", source.name) for source in sources} for half, sources in halves.items()}
    assert sessions[True] & sessions[False] == {"ax3", "sis"}, sessions  # three wearers of one kind of logger; persons of one study


@test
def a_stream_at_another_rate_has_the_same_noise_density():
    scenario = streams.MADE_SCENARIOS["gaps-jitter"]
    assert streams.at_rate(scenario, 100) == scenario
    fast = streams.at_rate(scenario, 400)
    assert fast.rate_hz == 400 and fast.noise_lsb == tuple(2.0 * lsb for lsb in scenario.noise_lsb)
    assert 1e6 / fast.rate_hz / fast.jitter_us == 1e6 / scenario.rate_hz / scenario.jitter_us


@test
def a_recording_is_slowed_down_only_where_that_is_honest():
    index = {s.name: {"name": s.name, "path": pathlib.Path("x"), "range": "2g", "rate_hz_nominal": "400", "dt_med_us": "2500", "dur_s": "30"}
             for s in streams.RECORDINGS}
    rates = {}
    for job in streams.recording_jobs(index):
        rates.setdefault(job.key(), []).append((job.rate_hz, job.divide))
    assert rates["handling:ax3-400-csv:0"] == [(25, 16), (50, 8), (100, 4), (200, 2), (400, 1)]
    assert rates["vibration:uav-agg-poll166:0"] == [(400, 1)]
    assert rates["vibration:car-brake:0"] == [(25, 1)]
    assert "rest:freeimu-orient-a:54.9" not in rates  # it ends before


@test
def a_folder_of_recordings_that_cannot_be_read_is_named():
    folder, head = OUT / "recordings", ",".join(streams.COLUMNS)
    for part in ("open", "test-only"):
        (folder / part).mkdir(parents=True, exist_ok=True)
    with mock.patch.dict(os.environ, {"RECORDINGS": str(folder)}):
        for text, words in ((None, "open/index.csv: cannot be read"), (head + "\n", "open/index.csv: no rows"),
                            (head.replace("range", "ring") + "\nx,9,100,10000,2g\n", "open/index.csv: no column range"),
                            (head + "\nx,9,100,10000,2g\n", "no recording 'gy85-tilt-92hz' in its index")):
            for part in ("open", "test-only"):
                (folder / part / "index.csv").unlink(missing_ok=True)
                if text is not None:
                    (folder / part / "index.csv").write_text(text, encoding="utf-8")
            assert "\n" not in refused(Fault, lambda: streams.recording_jobs(streams.recordings_index()), words)


if __name__ == "__main__":
    raise SystemExit(run_all())
