"""Checks in which the board is turned or shaken."""
import collections
import math

from tilt import protocol
from tilt.realboard import watch
from tilt.realboard.bench import Failed

REST_S = 1.0
REST_MG = 40         # spread of each filtered axis at rest
ONE_G_MG = (800, 1280)  # |a| on a face of any ADXL345, offset and sensitivity included; an ADXL343 or ADXL375 is outside or close to the limit
FACE_SHARE = 0.85    # of |a| on one axis
FACES = ("+x", "-x", "+y", "-y", "+z", "-z")
SHAKEN_LSB, SHAKEN_ROWS = 60, 20  # least deviation of a reading, and how many of them
MOVED_DEG = 1.0


class Window:
    """The rows of the last second."""

    def __init__(self):
        self.rows, self.times = collections.deque(), collections.deque()

    def add(self, seen):
        self.rows.append(seen.row)
        self.times.append(seen.at_s)
        while self.times[-1] - self.times[0] > REST_S:
            self.rows.popleft()
            self.times.popleft()

    def at_rest(self):
        full = len(self.rows) > 2 and self.times[-1] - self.times[0] > 0.9 * REST_S
        return full and all(max(axis) - min(axis) <= REST_MG for axis in zip(*map(watch.mg, self.rows)))

    def clear(self):
        self.rows.clear()
        self.times.clear()


def face_of(mean):
    """(face that points up, |a|); None between faces."""
    length = math.hypot(*mean)
    axis = max(range(3), key=lambda each: abs(mean[each]))
    if length == 0 or abs(mean[axis]) < FACE_SHARE * length:
        return None, length
    return "+-"[mean[axis] < 0] + "xyz"[axis], length


def six_faces(bench):
    """|a| on each of the six sides."""
    window, found = Window(), {}
    for seen in bench.events(bench.limit_s):
        watch.not_reset(seen)
        if seen.kind != "row" or seen.row.flags & protocol.NO_SAMPLE:
            continue
        window.add(seen)
        if not window.at_rest():
            continue
        face, length_mg = face_of(watch.mean_mg(window.rows))
        window.clear()
        if face and face not in found:
            found[face] = round(length_mg)
            bench.measured(**{f"{face}_mg": found[face]})
            bench.say(f"   {face} up: {found[face]} mg, {len(FACES) - len(found)} to go")
        if len(found) == len(FACES):
            break
    judge_faces(bench, found)


def judge_faces(bench, found):
    low, high = ONE_G_MG
    wrong = [f"{face} {mg}" for face, mg in found.items() if not low <= mg <= high]
    if wrong:
        raise Failed(f"not {low} to {high} mg: {', '.join(wrong)}")
    missing = [face for face in FACES if face not in found]
    if missing:
        raise Failed(f"not seen at rest within {bench.limit_s:.0f} s: {', '.join(missing)}")


def shake(bench):
    """Knocks do not change the tilt: it is the same after them."""
    before = rest(bench)
    bench.say("   Now knock on the table beside the board, hard, for five seconds; then let it lie.")
    shaken, gated, worst_deg = shaking(bench, before)
    after = rest(bench)
    moved_deg = watch.angle_deg(watch.mean_mg(before), watch.mean_mg(after))
    bench.measured(readings_off=shaken, rows_gated=gated, worst_deg=round(worst_deg, 2), moved_deg=round(moved_deg, 3))
    if moved_deg > MOVED_DEG:
        raise Failed(f"the tilt changed by {moved_deg:.2f} degrees: has the board moved?")


def rest(bench):
    """The rows of a second at rest."""
    window = Window()
    for seen in bench.events(bench.limit_s):
        watch.not_reset(seen)
        if seen.kind == "row":
            window.add(seen)
            if window.at_rest():
                return list(window.rows)
    raise Failed(f"the board was not at rest within {bench.limit_s:.0f} s")


def shaking(bench, before):
    """(readings far off, gated rows, largest angle of the filtered rows) until a second passes without any."""
    mean = [sum(axis) / len(axis) for axis in zip(*(row.values[1:4] for row in before))]
    lies, shaken, gated, worst_deg, last_s = watch.mean_mg(before), 0, 0, 0.0, None
    for seen in bench.events(bench.limit_s):
        watch.not_reset(seen)
        if seen.kind != "row":
            continue
        off = max(abs(value - middle) for value, middle in zip(seen.row.values[1:4], mean)) > SHAKEN_LSB
        shaken, last_s = shaken + off, seen.at_s if off else last_s
        gated += bool(seen.row.flags & protocol.GATED)
        worst_deg = max(worst_deg, watch.angle_deg(watch.mg(seen.row), lies))
        if shaken >= SHAKEN_ROWS and seen.at_s - last_s > REST_S:
            return shaken, gated, worst_deg
    raise Failed(f"only {shaken} of {SHAKEN_ROWS} readings more than {SHAKEN_LSB} LSB off within {bench.limit_s:.0f} s: knock harder")
