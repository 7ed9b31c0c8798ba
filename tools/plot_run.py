#!/usr/bin/env python3
"""Draws a run of the firmware, raw against filtered tilt, and prints its errors.

    plot_run.py --run OUT.csv --png OUT.png [--stream IN.csv] [--served SERVED.csv] [--stats STATS.json] [--title TEXT]

--run is what the firmware sent (docs/protocol.md). Raw roll and pitch are computed here from its *_lsb columns. Truth
comes from --served (what the sensor latched) or else from --stream, if they have roll_true_cdeg and pitch_true_cdeg;
rows are matched with theirs by reading and time. Errors are wrapped; rows warming up or without a sample are not scored.
"""
import json
import sys
from collections import Counter
from types import SimpleNamespace

try:
    import numpy as np

    from tilt import picture
    from tilt.angles import ANGLES, raw_angles_deg, wrapped_deg
    from tilt.options import Parser
    from tilt.look import FILE_COLOURS, GATED_COLOUR, MISSING_BAND, RAW_COLOUR, TRUTH_COLOUR, WARMING_BAND
    from tilt.protocol import GATED, NO_SAMPLE, WARMING_UP, WRAP_US
except ImportError as missing:
    sys.exit(f"plot_run: {missing.name} is missing: run `make deps`, or use a Python that has tools/deps/requirements.txt")

RUN_COLUMNS = ["t_us", "x_lsb", "y_lsb", "z_lsb", "x_mg", "y_mg", "z_mg", "roll_cdeg", "pitch_cdeg", "flags"]
READING = ["x_lsb", "y_lsb", "z_lsb"]
TRUTH = ["roll_true_cdeg", "pitch_true_cdeg"]
OFFSET_BIN_US = 100       # clocks are aligned by the most frequent difference, with this resolution
VOTING_ROWS = 400         # rows used for that
FASTER = 1.05             # times the stream's rate: the sensor repeats readings
MATCH_WINDOW_STEPS = 1.5  # a row's truth is at most this many rows away in time
PICTURE_INCHES, PICTURE_DPI = (12.0, 7.0), 100


class InputError(Exception):
    """A file that cannot be used; the text names the file, the place and the reason."""


# --- reading ----------------------------------------------------------------------------------------------------------


def read_lines(path):
    try:
        with open(path, encoding="utf-8-sig", errors="replace") as file:
            return file.read().splitlines()
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from error


def read_numbers(path, wanted, optional=()):
    """({column: int64 array}, readings cut short) of the CSV file; every wanted column must be there.

    A repeated header is skipped. A row cut short by a reset of the board ends with the '#' of the next banner, and a capture may
    end within a row: these two are counted; any other bad row is an error with file, line and reason.
    """
    lines = read_lines(path)
    header, names, places, rows, cut = None, [], [], [], 0
    for number, line in enumerate(lines, 1):
        fields = line.split(",")
        if line.lstrip().startswith("#") or not line.strip():
            continue
        if header is None:
            header, (names, places) = fields, find_columns(path, number, fields, wanted, optional)
        elif fields != header:
            try:
                rows.append(numbers_of(fields, len(header), places))
            except ValueError as error:
                if "#" not in line and number != len(lines):
                    raise InputError(f"{path}:{number}: {error}") from error
                cut += 1
    if not rows:
        raise InputError(f"{path}: no rows" if header else f"{path}: empty, no header with {','.join(wanted)}")
    table = np.array(rows, dtype=np.int64)
    return {name: table[:, i] for i, name in enumerate(names)}, cut


def find_columns(path, number, fields, wanted, optional):
    """(names, positions) of the wanted columns and of the optional ones that exist; x means x_lsb."""
    present = [field.strip() + "_lsb" if field.strip() in ("x", "y", "z") else field.strip() for field in fields]
    missing = [name for name in wanted if name not in present]
    if missing:
        raise InputError(f"{path}:{number}: column {missing[0]} is missing (the csv header was expected here)")
    names = [name for name in (*wanted, *optional) if name in present]
    return names, [present.index(name) for name in names]


def numbers_of(fields, count, places):
    """Whole numbers at these positions of a row; ValueError names what is wrong with the row."""
    if len(fields) != count:
        raise ValueError(f"{len(fields)} fields, the header has {count}")
    for place in places:
        if not fields[place].strip().lstrip("+-").isdecimal():
            raise ValueError(f"'{fields[place]}' is not a whole number")
    return [int(fields[place]) for place in places]


def read_stats(path):
    """The flat JSON object of simrun --stats; {} without a file."""
    if path is None:
        return {}
    try:
        stats = json.loads("\n".join(read_lines(path)))
    except json.JSONDecodeError as error:
        raise InputError(f"{path}:{error.lineno}: {error.msg}") from error
    if not isinstance(stats, dict):
        raise InputError(f"{path}: not a JSON object")
    return stats


# --- angles and truth -------------------------------------------------------------------------------------------------


def unwrap_us(t_us):
    """uint32 times as one growing series; after a small step back (a reset of the board) a new segment follows directly."""
    steps = np.diff(t_us)
    steps = np.where(steps < -WRAP_US // 2, steps + WRAP_US, steps)
    usual = int(np.median(steps[steps > 0])) if np.any(steps > 0) else 1
    return t_us[0] + np.concatenate(([0], np.cumsum(np.where(steps < 0, usual, steps))))


def segments(t_us):
    """Slices of rows between resets of the board's clock."""
    steps = np.diff(t_us)
    cuts = np.flatnonzero((steps < 0) & (steps >= -WRAP_US // 2)) + 1
    return [slice(a, b) for a, b in zip([0, *cuts], [*cuts, len(t_us)])]


def reading_keys(table):
    x, y, z = (table[name] + 32768 for name in READING)
    return (x << 32) | (y << 16) | z


def clock_offset_us(t_us, keys, source_t_us, source_keys):
    """Row time minus source time on which most of the first rows agree; None if they have no reading in common."""
    votes = Counter()
    for t, key in zip(t_us[:VOTING_ROWS], keys[:VOTING_ROWS]):
        differences = t - source_t_us[source_keys == key]
        votes.update(np.unique(np.floor_divide(differences + OFFSET_BIN_US // 2, OFFSET_BIN_US)).tolist())
    if not votes:
        return None
    best = max(votes, key=lambda bin_: (votes[bin_] + votes[bin_ - 1] + votes[bin_ + 1], -abs(bin_)))
    return best * OFFSET_BIN_US


def nearest_same_reading(t_us, keys, source_t_us, source_keys):
    """For each row the index of the source row with the same reading closest in time, -1 if none is close enough."""
    step = float(np.median(np.diff(source_t_us))) if len(source_t_us) > 1 else 1.0
    found = np.full(len(t_us), -1)
    distance = np.full(len(t_us), MATCH_WINDOW_STEPS * step)
    centre = np.searchsorted(source_t_us, t_us)
    for shift in (-2, -1, 0, 1):
        index = np.clip(centre + shift, 0, len(source_t_us) - 1)
        away = np.abs(source_t_us[index] - t_us)
        better = (source_keys[index] == keys) & (away < distance)
        found[better], distance[better] = index[better], away[better]
    return found


def match_rows(run, source):
    """For each row of the run the source row it shows, -1 for rows without a sample and rows without a match."""
    matched = np.full(len(run["t_us"]), -1)
    source_t, source_keys, keys = unwrap_us(source["t_us"]), reading_keys(source), reading_keys(run)
    for part in segments(run["t_us"]):
        t_us = unwrap_us(run["t_us"][part])
        offset = clock_offset_us(t_us, keys[part], source_t, source_keys)
        if offset is not None:
            matched[part] = nearest_same_reading(t_us - offset, keys[part], source_t, source_keys)
    matched[(run["flags"] & NO_SAMPLE) != 0] = -1
    return matched


def take_truth(source, matched):
    if source is None or any(name not in source for name in TRUTH):
        return None
    return {angle: np.where(matched >= 0, source[name][matched] / 100.0, np.nan)
            for angle, name in zip(ANGLES, TRUTH)}


# --- summary ----------------------------------------------------------------------------------------------------------


def analyse(run, source):
    """Everything that is drawn or printed, from the run and the table with the truth (or None)."""
    flags = run["flags"]
    result = SimpleNamespace(rows=len(flags), flags=flags)
    result.t_s = (unwrap_us(run["t_us"]) - run["t_us"][0]) * 1e-6
    result.raw = raw_angles_deg(np.stack([run[name] for name in READING], axis=1))
    result.filtered = {angle: run[angle + "_cdeg"] / 100.0 for angle in ANGLES}
    result.no_sample = (flags & NO_SAMPLE) != 0
    result.warming = (flags & WARMING_UP) != 0
    result.gated = (flags & GATED) != 0
    matched = match_rows(run, source) if source is not None else None
    result.unmatched = None if matched is None else int(np.sum((matched < 0) & ~result.no_sample))
    result.truth = None if matched is None else take_truth(source, matched)
    result.rmse = {} if result.truth is None else {angle: rmse_pair(result, angle) for angle in ANGLES}
    return result


def rmse_pair(result, angle):
    """(raw, filtered) root mean square error in degrees over the same rows; NaN if no row can be scored."""
    scored = ~result.warming & ~result.no_sample & ~np.isnan(result.truth[angle])
    if not np.any(scored):
        return float("nan"), float("nan")
    errors = (wrapped_deg(series[scored] - result.truth[angle][scored])
              for series in (result.raw[angle], result.filtered[angle]))
    return tuple(float(np.sqrt(np.mean(error ** 2))) for error in errors)


def percent(part, whole):
    return f"{100.0 * part / whole:.1f} %" if whole else "-"


def repeats(stats, stream):
    """The line about a sensor that samples faster than its stream has rows; nothing if it does not."""
    steps_us = np.diff(unwrap_us(read_numbers(stream, ["t_us"])[0]["t_us"])) if stream else []
    sensor_hz = stats.get("sensor_hz") or 0.0
    if not len(steps_us) or sensor_hz <= FASTER * 1e6 / np.median(steps_us):
        return []
    stream_hz = 1e6 / np.median(steps_us)
    return [f"the stream has {stream_hz:.4g} rows/s, the sensor took {sensor_hz:.4g}/s: it repeats each reading, so outliers come in a row and "
            f"errors are larger than a real sensor's: give RATE={stream_hz:.3g} or less, or a faster stream"]


def summary_lines(result, stats, cut):
    unscored = int(np.sum(result.warming | result.no_sample))
    known = [("samples served", "samples_served"), ("lost", "lost"), ("resets", "resets")]
    head = [f"rows {result.rows}"] + [f"{label} {stats[key]}" for label, key in known if stats.get(key) is not None]
    head.append(f"gated {percent(np.sum(result.gated), result.rows)}")
    if isinstance(stats.get("cpu_load"), (int, float)):
        head.append(f"CPU load {100.0 * stats['cpu_load']:.1f} %")
    lines = [", ".join(head)]
    for angle, (raw, filtered) in result.rmse.items():
        lines.append(f"{angle:5s} error, rms: raw {raw:.2f} degrees, filtered {filtered:.2f} degrees"
                     + (f" ({filtered / raw:.2f} of raw)" if raw > 0.0 else ""))
    if not result.rmse:
        lines.append("no truth columns: errors not computed")
    lines.append(f"not scored: {unscored} rows warming up or without a sample")
    if result.unmatched:
        lines.append(f"{result.unmatched} rows have a reading that was not served at that time")
    if cut:
        lines.append(f"{cut} rows cut short by a reset or by the end of the capture")
    return lines


# --- picture ----------------------------------------------------------------------------------------------------------


def draw_panel(axes, result, angle):
    measured, lines = ~result.no_sample, [result.filtered[angle]] + ([] if result.truth is None else [result.truth[angle]])
    raw, limits = result.raw[angle], picture.limits_of(result.raw[angle], lines)
    unbroken = np.zeros(result.rows, bool)
    picture.shade(axes, result.t_s, result.no_sample, *MISSING_BAND)
    picture.shade(axes, result.t_s, result.warming, *WARMING_BAND)
    picture.points(axes, result.t_s, raw, ~result.gated & measured, limits, ls="", marker=".", ms=2.4, color=RAW_COLOUR, label="raw", zorder=1)
    picture.refused(axes, result.t_s, raw, result.gated & measured, limits, GATED_COLOUR, "raw of gated rows")
    picture.line(axes, result.t_s, result.filtered[angle], unbroken, True, lw=1.5, color=FILE_COLOURS[0], label="filtered", zorder=4)
    if result.truth is not None:
        picture.line(axes, result.t_s, result.truth[angle], unbroken, True, lw=1.0, ls="--", color=TRUTH_COLOUR, label="truth", zorder=5)
    axes.set_ylim(*limits)
    picture.style(axes, picture.unit(angle))
    notes = ["rms error: raw {:.2f}, filtered {:.2f} degrees".format(*result.rmse[angle])] if angle in result.rmse else []
    notes.append(picture.outside_note(raw[measured], limits))
    axes.set_title("   ".join(filter(None, notes)), loc="right", fontsize=9, color="#444444", pad=3)


def draw(result, title, png):
    figure = picture.Figure(figsize=PICTURE_INCHES, dpi=PICTURE_DPI)
    panels = figure.subplots(2, 1, sharex=True)
    for axes, angle in zip(panels, ANGLES):
        draw_panel(axes, result, angle)
    panels[1].set_xlabel("seconds")
    panels[1].set_xlim(result.t_s[0], max(result.t_s[-1], result.t_s[0] + 0.01))
    handles, labels = panels[0].get_legend_handles_labels()
    figure.suptitle(title, x=0.01, ha="left", fontsize=13, fontweight="bold")
    figure.legend(handles, labels, loc="upper right", ncol=len(labels), fontsize=9, frameon=False, markerscale=2.0)
    figure.tight_layout(rect=(0.0, 0.0, 1.0, 0.985))
    try:
        figure.savefig(png)
    except OSError as error:
        raise InputError(f"{png}: {error.strerror}") from error


# --- command ----------------------------------------------------------------------------------------------------------


def parse_arguments(arguments):
    parser = Parser(prog="plot_run", description=__doc__.splitlines()[0])
    parser.add_argument("--run", required=True, help="CSV sent by the firmware")
    parser.add_argument("--png", required=True, help="picture to write")
    parser.add_argument("--stream", help="CSV played by the sensor (for the truth, if --served has none)")
    parser.add_argument("--served", help="CSV of the sensor's latched rows (simrun --served)")
    parser.add_argument("--stats", help="JSON of simrun --stats")
    parser.add_argument("--title", default="", help="title of the picture")
    return parser.parse_args(arguments)


def truth_source(options):
    """The table to match rows with: the served one, or the stream if only that has truth."""
    tables = [read_numbers(path, ["t_us", *READING], TRUTH)[0] for path in (options.served, options.stream) if path]
    with_truth = [table for table in tables if all(name in table for name in TRUTH)]
    return next(iter(with_truth or tables), None)


def main(arguments=None):
    options = parse_arguments(arguments)
    try:
        run, cut = read_numbers(options.run, RUN_COLUMNS)
        result = analyse(run, truth_source(options))
        stats = read_stats(options.stats)
        repeated = repeats(stats, options.stream)
        draw(result, options.title or options.run, options.png)
    except InputError as error:
        print(f"plot_run: {error}", file=sys.stderr)
        return 2
    print("\n".join(summary_lines(result, stats, cut) + repeated))
    print(f"picture: {options.png}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
