"""Checks in which the board restarts: its button, its supply, D4, and what it keeps."""
import contextlib
import statistics

from tilt.realboard import watch
from tilt.realboard.bench import Failed

BUTTON = "reset button or serial port opened"
ROWS_AFTER_S = 5.0  # after the banner
UNREAD = "defaults, saved ones not read"
BROKEN = ("defaults, saved ones damaged", UNREAD)
TYPED, REST = "every 4", "4"
SETS = (("every 3", "offset 1 2 3"), ("every 5", "offset -4 -5 -6"))  # no value in common: a mixture equals neither
SAVES_MAX = 300     # of 100,000 writes that an EEPROM byte endures
SAVED_S = 5.0
CHANGED = ("offset", "level", "every")
KEPT_EVERY = 7
KEPT_OFF_S = 8.0    # the owner counts to ten
LEVEL_DEG = 1.0     # allowed change after the board was plugged in again


def reset_button(bench):
    """A banner that names the cause, and rows."""
    start = watch.restart(bench)
    rows_after(bench, start)
    if start.cause != BUTTON:
        raise Failed(f"the board names the cause '{start.cause}', not '{BUTTON}'")


def rows_after(bench, start):
    """Rows after the banner, without a fault."""
    begun_s = start.banner.at_s if start.banner else bench.now()
    bench.measured(cause=start.cause, settings=start.kept, silent_s=round(begun_s - start.since_s, 3),
                   port_gone_s=None if start.port_gone_s is None else round(start.port_gone_s, 3))
    first = watch.row_with_sample(bench, ROWS_AFTER_S)
    bench.measured(rows_back_s=round(first.at_s - begun_s, 3))
    ready(bench)
    bench.measured(rate_hz=round(watch.steady(bench).rate_hz, 2))


def ready(bench):
    """Sets what the checks need: a row for each of 100 samples a second. Nothing of it is saved."""
    if bench.wire.baud < 115200:
        watch.reply(bench, "baud 115200", r"# baud 115200$")
    for command, answer in (("mode csv", "# mode csv"), (f"rate {watch.RATE_HZ}", f"# rate {watch.RATE_HZ} Hz"), ("every 1", "# every 1")):
        watch.reply(bench, command, answer)


def reset_typing(bench):
    """Text typed before the reset does not become part of what is typed after it."""
    bench.type(TYPED, piece=True)
    try:
        start = watch.restart(bench)
    except BaseException:
        with contextlib.suppress(Failed):
            bench.type("\n", piece=True)  # otherwise it would begin the next command
        raise
    rest_is_refused(bench)
    rows_after(bench, start)


def rest_is_refused(bench):
    """The line begun before the reset is gone."""
    watch.row_with_sample(bench, ROWS_AFTER_S)
    with contextlib.suppress(Failed):  # the refusal is the right answer
        watch.reply(bench, REST, "# every")
    every = watch.setting(bench, "every")
    bench.measured(every=every)
    if every == TYPED.split()[1] + REST:
        raise Failed(f"text typed before the reset was joined to text typed after it: every {every}")


def power_second(bench):
    """The supply fails for a second."""
    start = watch.restart(bench, needs_gone=True)
    rows_after(bench, start)
    if start.kept in BROKEN:
        raise Failed(f"the settings are '{start.kept}'")


def strap(bench):
    """D4 at ground gives the defaults and leaves the saved settings."""
    start = watch.restart(bench)
    bench.measured(with_d4=start.kept)
    if start.kept != UNREAD:
        raise Failed(f"with D4 at GND the settings are '{start.kept}', not '{UNREAD}'")
    bench.say("   Now take the wire off D4 and press reset again.")
    start = watch.restart(bench)
    rows_after(bench, start)
    if start.kept in BROKEN:
        raise Failed(f"without the wire the settings are '{start.kept}'")


# --- the EEPROM -------------------------------------------------------------------------------------------------------

def eeprom_cut(bench):
    """Saves two sets in turn until the supply fails: afterwards the board has one of them whole."""
    with as_before(bench):
        saved, under_way, count = save_until_gone(bench)
        bench.measured(saves=count)
        start = watch.restart(bench, needs_gone=True)
        bench.measured(cause=start.cause, settings=start.kept)
        watch.row_with_sample(bench, watch.ROWS_WITHIN_S)
        found = tuple(f"{name} {watch.setting(bench, name)}" for name in ("every", "offset"))
        bench.measured(read_back="; ".join(found))
        if found not in (saved, under_way):
            raise Failed(f"the board has '{'; '.join(found)}', neither '{'; '.join(saved)}' nor '{'; '.join(under_way)}'")
        if start.kept in BROKEN:
            raise Failed(f"the settings are '{start.kept}'")


def save_until_gone(bench):
    """(the last set reported as saved, the one being saved, number of saves)"""
    until_s, saved = bench.now() + bench.limit_s, tuple(f"{name} {bench.settings.get(name)}" for name in ("every", "offset"))
    for count in range(1, SAVES_MAX + 1):
        under_way = SETS[count % 2]
        try:
            for command in under_way:
                watch.reply(bench, command, f"# {command.split()[0]} ")
            watch.reply(bench, "save", r"# saved$", SAVED_S)
        except Failed as why:
            if "refused" in str(why):
                raise
            return saved, under_way, count
        saved = under_way
        if bench.now() > until_s:
            break
    raise Failed(f"the supply was not cut within {bench.limit_s:.0f} s or {count} saves")


def kept(bench):
    """The mounting that `tare` measures and a setting survive ten seconds without supply."""
    with as_before(bench):
        watch.reply(bench, "tare", "# tare: hold still")
        level = watch.value_of(watch.said(bench, "# level ([^:]+)", bench.limit_s, "result of 'tare'")[1][1])
        watch.reply(bench, f"every {KEPT_EVERY}", f"# every {KEPT_EVERY}")
        watch.reply(bench, "save", r"# saved$", SAVED_S)
        bench.say("   Now pull the USB plug, count slowly to ten, and put it back. Do not move the board.")
        start = watch.restart(bench, needs_gone=True)
        watch.row_with_sample(bench, watch.ROWS_WITHIN_S)
        found = watch.setting(bench, "level"), watch.setting(bench, "every")
        bench.measured(cause=start.cause, settings=start.kept, level=found[0], every=found[1],
                       off_s=None if start.port_gone_s is None else round(start.port_gone_s, 1))
        if found != (level, str(KEPT_EVERY)):
            raise Failed(f"the board has level {found[0]} and every {found[1]}, but saved level {level} and every {KEPT_EVERY}")
        lies_level(bench)
        if start.port_gone_s is not None and start.port_gone_s < KEPT_OFF_S:
            raise Failed(f"the plug was out for only {start.port_gone_s:.1f} s: repeat the check")


def lies_level(bench):
    """Roll and pitch are zero, as `tare` set them."""
    rows = watch.stretch(bench, watch.STRETCH_S).rows
    if not rows:
        raise Failed("no rows")
    roll, pitch = (statistics.fmean(axis) / 100 for axis in zip(*(row.values[7:9] for row in rows)))
    bench.measured(roll_deg=round(roll, 2), pitch_deg=round(pitch, 2))
    if max(abs(roll), abs(pitch)) > LEVEL_DEG:
        raise Failed(f"roll {roll:.1f} and pitch {pitch:.1f} degrees instead of 0: was the board moved?")


@contextlib.contextmanager
def as_before(bench):
    """Restores and saves the settings that the EEPROM checks change, whatever happens."""
    try:
        yield
    finally:
        bench.deaf = True
        try:
            put_settings_back(bench)
        except Failed as why:
            was = ", ".join(f"'{name} {bench.settings[name]}'" for name in CHANGED if name in bench.settings)
            bench.say(f"   The settings could not be restored ({why}): type {was}, 'save'.")
        bench.deaf = False


def put_settings_back(bench):
    watch.row_with_sample(bench, ROWS_AFTER_S)
    for name in CHANGED:
        if name in bench.settings:
            watch.reply(bench, f"{name} {bench.settings[name]}", f"# {name} ")
    watch.reply(bench, "save", r"# saved$", SAVED_S)
