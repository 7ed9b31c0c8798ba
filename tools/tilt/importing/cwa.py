"""CWA, the files of the Axivity AX3, whose sensor is an ADXL345: a header of 1,024 bytes, then blocks of 512 with up to 120 samples.

Source: the maker's description (openmovementproject/openmovement, Docs/ax3/cwa.h). Little endian throughout. In a block: the letters AX,
length 508, fraction of a second (15 bits if bit 15 is set), session, sequence number, date and time, light (the top three bits n: an
unpacked count is 1/2^(8 + n) g), ..., rate code (3200 / 2^(15 - low nibble) Hz), axes (high nibble) and packing (low nibble: 0 is 3 x 10
bits with a common exponent in 32 bits, 2 is 3 x 16 bits), the sample to which the time stamp belongs, the number of samples; last a word
that makes the sum of all words 0.
"""
import calendar
import os

import numpy as np

from tilt.errors import TiltError
from tilt.importing.readings import Readings
from tilt.importing.source import progress

HEADER, BLOCK, DATA_AT = 1024, 512, 30
AX6, ADXL345_ACCEL_SCALE = 0x64, 0
PACKED, WORDS = 0x30, 0x32
BLOCKS_FITTED, BLOCKS_AVERAGED = 256, 64  # a run of up to this many blocks gets one line; a longer one a knot every so many
HEAD = np.dtype([("letters", "<u2"), ("length", "<u2"), ("fraction", "<u2"), ("session", "<u4"), ("sequence", "<u4"), ("stamp", "<u4"),
                 ("light", "<u2"), ("temperature", "<u2"), ("events", "u1"), ("battery", "u1"), ("rate", "u1"), ("axes", "u1"),
                 ("offset", "<i2"), ("count", "<u2")])


def read(path, file):
    """The Readings of a CWA file: LSB, and seconds from the first sample."""
    head = file.read(HEADER)
    if len(head) < HEADER:
        raise TiltError(f"{path}: cut short: the CWA header has {len(head)} bytes of {HEADER}: export it from the sensor again")
    if head[4] == AX6:
        raise TiltError(f"{path}: from an AX6, which has no ADXL345: record with an AX3")
    data = file.read()
    if len(data) % BLOCK:
        raise TiltError(f"{path}: cut short: block {HEADER // BLOCK + len(data) // BLOCK} has {len(data) % BLOCK} bytes of {BLOCK}: "
                        "export it from the sensor again")
    found = np.frombuffer(data, dtype=np.uint8).reshape(-1, BLOCK)
    if len(found) == 0:
        raise TiltError(f"{path}: only a header, no blocks: record again")
    heads = np.ascontiguousarray(found[:, :DATA_AT]).view(HEAD).ravel()
    check(path, found, heads)
    values = []
    with progress(os.path.getsize(path), path, "read") as bar:
        for block, info in zip(found, heads):
            values.append(samples_of(block, info))
            bar.update(BLOCK)
    notes = []
    time = times_of(heads, notes)
    return Readings(path, "CWA", np.concatenate(values).astype(np.float64), None, time, "s", None, "raw", notes=notes)


def check(path, found, heads):
    """Checks that every block is complete and from an ADXL345."""
    sums = found.view("<u2").sum(axis=1, dtype=np.uint32) & 0xFFFF
    room = np.where(heads["axes"] == PACKED, 120, 80)
    faults = [((heads["letters"] != 0x5841) | (heads["length"] != BLOCK - 4), "not a data block (AX)"),
              (sums != 0, "wrong checksum"),
              ((heads["axes"] != PACKED) & (heads["axes"] != WORDS), "not three axes, packed or in words"),
              ((heads["axes"] == WORDS) & (heads["light"] >> 13 != ADXL345_ACCEL_SCALE), "counts are not 1/256 g: not an ADXL345"),
              ((heads["count"] == 0) | (heads["count"] > room), "impossible number of samples")]
    for bad, reason in faults:
        if bad.any():
            block = int(np.flatnonzero(bad)[0]) + HEADER // BLOCK
            raise TiltError(f"{path}: block {block} (byte {block * BLOCK}): {reason}: export it from the sensor again")


def samples_of(block, info):
    """(count, 3) LSB."""
    count = int(info["count"])
    if info["axes"] == WORDS:
        return block[DATA_AT:DATA_AT + 6 * count].view("<i2").reshape(-1, 3).astype(np.int32)
    packed = block[DATA_AT:DATA_AT + 4 * count].view("<u4")
    axes = [((packed >> shift) & 0x3FF).astype(np.int32) for shift in (0, 10, 20)]
    signed = np.stack([np.where(axis >= 512, axis - 1024, axis) for axis in axes], axis=1)
    return signed << (packed >> 30).astype(np.int32)[:, None]


def rate_of(code):
    return 3200.0 / (1 << (15 - (int(code) & 0x0F)))


def seconds_of(stamp):
    """Seconds since 1970 of a packed date: years from 2000 in 6 bits, month 4, day 5, hour 5, minute 6, second 6."""
    return calendar.timegm((2000 + (stamp >> 26 & 63), stamp >> 22 & 15, stamp >> 17 & 31, stamp >> 12 & 31, stamp >> 6 & 63, stamp & 63))


def times_of(heads, notes):
    """Seconds of each sample from the first: in each run of consecutive blocks, as evenly spaced as the stamps allow."""
    counts = heads["count"].astype(np.int64)
    starts = np.concatenate([[0], np.cumsum(counts)])
    stamps = np.array([seconds_of(int(stamp)) for stamp in heads["stamp"]], dtype=np.float64)
    stamps -= stamps[0]  # small numbers keep their microseconds
    rates = np.array([rate_of(code) for code in heads["rate"]])
    fractions = np.where(heads["fraction"] & 0x8000, (heads["fraction"] & 0x7FFF) / 32768.0, 0.0)
    # with a fraction, the recorder moved the offset back by that part of a second, in whole samples
    offsets = heads["offset"] + np.floor(fractions * rates)
    anchors = np.stack([starts[:-1] + offsets, stamps + fractions], axis=1)
    breaks = np.flatnonzero((np.diff(heads["sequence"].astype(np.int64)) != 1) | (np.diff(heads["rate"].astype(np.int64)) != 0)
                            | (np.diff(heads["session"].astype(np.int64)) != 0)) + 1
    if len(breaks):
        notes.append(f"{len(breaks)} breaks in the sequence of blocks")
    edges = [0, *breaks.tolist(), len(heads)]
    times = [along(anchors[a:b], np.arange(starts[a], starts[b]), rates[a]) for a, b in zip(edges, edges[1:])]
    whole = np.concatenate(times)
    return whole - whole[0]


def along(anchors, samples, rate):
    """Times of the samples of one run from its (sample, time) anchors, which are whole seconds and so sometimes a sample off."""
    if len(anchors) > BLOCKS_FITTED:
        cut = len(anchors) // BLOCKS_AVERAGED
        at_sample, at_time = np.array([part.mean(axis=0) for part in np.array_split(anchors, cut)]).T
        inside = np.interp(samples, at_sample, at_time)
        for outside, (a, b) in ((samples < at_sample[0], (0, 1)), (samples > at_sample[-1], (-2, -1))):
            slope = (at_time[b] - at_time[a]) / (at_sample[b] - at_sample[a])
            inside[outside] = at_time[a] + (samples[outside] - at_sample[a]) * slope
        return inside
    middle = anchors.mean(axis=0)
    off = anchors - middle
    spread = (off[:, 0] ** 2).sum()
    period = (off[:, 0] * off[:, 1]).sum() / spread if spread > 0.0 else 1.0 / rate
    return middle[1] + (samples - middle[0]) * period
