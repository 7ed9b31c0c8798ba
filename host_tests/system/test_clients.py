"""Other people's ADXL345 libraries with their example sketches (host_tests/system/clients.mk) on the simulated UNO: they find the sensor model, and
what they print is what the sensor measured. Skipped where the libraries are not there."""
import csv
import pathlib
import re
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import OUT, SIMRUN, STREAMS, Skip, run, run_all, test

BUILT = pathlib.Path("build/clients")
ROUNDED = 0.005 + 1e-5  # of two decimals
MG, MS2 = 0.0039, 0.004 * 9.80665  # g and m/s2 per LSB, as the libraries have them
NUMBER = r"(-?\d+(?:\.\d+)?)"
IN_G = rf"g-x   = {NUMBER}  \|  g-y   = {NUMBER}  \|  g-z   = {NUMBER}"


def client(name, max_ms=3000, *options):
    """(what a sketch prints, samples of the sensor in LSB as its registers have them)."""
    image = BUILT / f"{name}.elf"
    if not image.exists():
        raise Skip(f"no {image}: it needs ../shared/peers/drivers (PEER_DRIVERS=) and arduino-core-avr")
    OUT.mkdir(parents=True, exist_ok=True)
    out, served = OUT / f"{name}.txt", OUT / f"{name}.csv"
    run(SIMRUN, "--fw", image, "--in", STREAMS / "tilt-fast.csv", "--out", out, "--served", served, "--max-ms", max_ms, *options)
    with open(served, encoding="ascii") as file:
        samples = [tuple(int(row[f"{axis}_lsb"]) for axis in "xyz") for row in csv.DictReader(file)]
    return out.read_bytes().decode("ascii"), samples


def triples(text, pattern):
    return [tuple(map(float, found)) for found in re.findall(pattern, text)]


def places(printed, samples, scale, mixed=False):
    """For each triple the sample that it is, none earlier than the one before. mixed: the axes may be of two samples in a row."""
    found, at = [], 0
    for triple in printed:
        def fits(k):
            return all(any(abs(value - lsb[axis] * scale) <= ROUNDED for lsb in samples[k:k + 1 + mixed]) for axis, value in enumerate(triple))
        at = next((k for k in range(at, len(samples)) if fits(k)), None)
        assert at is not None, f"{triple} is not what the sensor measured, after {found[-1:]}"
        found.append(at)
    return found


@test
def adafruit_sensortest_prints_what_the_sensor_measured():
    text, samples = client("adafruit")
    assert "Data Rate:    100  Hz" in text and "Range:         +/- 16  g" in text, text
    printed = triples(text, rf"X: {NUMBER}  Y: {NUMBER}  Z: {NUMBER}  m/s")
    found = places(printed, samples, MS2, mixed=True)  # it reads the axes one by one
    assert len(found) > 40 and max(b - a for a, b in zip(found, found[1:])) < 15, found
    off = [*printed[:9], (printed[9][0], printed[9][1] + MS2 * 100, printed[9][2]), *printed[10:]]
    try:
        places(off, samples, MS2, mixed=True)
    except AssertionError:
        return
    raise AssertionError("a wrong value was not found")


@test
def sparkfun_example_reads_every_sample_with_10_bits():
    text, samples = client("sparkfun")
    printed = triples(text, rf"(?m)^{NUMBER} {NUMBER} {NUMBER}\r")
    printed = printed[next(k for k, triple in enumerate(printed) if triple == samples[0]):]  # before the first sample the registers hold zeros
    found = places(printed, samples, 1)
    assert len(printed) > 2000 and max(b - a for a, b in zip(found, found[1:])) <= 5 and found[-1] >= len(samples) - 3, len(printed)


@test
def adxl345_we_reads_raw_values_and_g():
    text, samples = client("we_check")
    assert "Data rate: 50 Hz  /  g-Range: 4g" in text and "lost" not in text, text
    raw = triples(text, rf"Raw-x = {NUMBER}  \|  Raw-y = {NUMBER}  \|  Raw-z = {NUMBER}")
    assert len(raw) > 20 and len(places(raw, samples, 1)) == len(raw)
    assert len(places(triples(text, IN_G), samples, MG)) == len(raw)


@test
def adxl345_we_gets_every_sample_by_data_ready():
    text, samples = client("we_ready")
    found = places(triples(text, IN_G), samples, MG)
    assert len(found) > 290 and len(samples) - len(found) <= 2, (len(found), len(samples))
    assert found[-1] >= len(samples) - 3, "samples lost or repeated"


@test
def adxl345_we_fills_the_fifo_and_reads_it_in_order():
    text, samples = client("we_fifo")
    printed = triples(text, IN_G)
    assert "FiFo full" in text and len(printed) == 34 and 31 <= len(samples) <= 33, (len(printed), len(samples))
    assert all(places([triple], [sample], MG) == [0] for triple, sample in zip(printed, samples))
    assert set(printed[len(samples):]) == {printed[len(samples) - 1]}, "the last one is to stay"


@test
def without_a_sensor_they_say_so():
    for name, words in (("adafruit", "Ooops, no ADXL345 detected"), ("we_check", "ADXL345 not connected!")):
        text, samples = client(name, 500, "--fault", "0ms:unplug")
        assert words in text and not samples, text


if __name__ == "__main__":
    raise SystemExit(run_all())
