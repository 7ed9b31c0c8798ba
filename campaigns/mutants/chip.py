"""Mutants of what only the chip compiles, judged in the simulator: a few programs, made in the worker's tree by the Makefile's own rules, each
with tests of host_tests/system that run it alone, the cheapest first. No counter says which line a test reaches here.
"""
import shutil
import threading
import time

from judge import Same
from shop import ROOT, Stop, run

# program, then words that choose its tests, of system_tests.py or, before a colon, of another file of its folder; not those that break a source
# themselves, which a mutant of the same text would fail by accident; what store_keeps_a_set leaves, store_survives_power_cuts begins with: the
# quicker one is run before it
PROGRAMS = {
    "hal_probe": ("eeprom_is_written",),
    "store_probe": ("store_keeps_a_set", "store_survives_power_cuts"),
    "fx_twins": ("assembler_primitives_equal_their_c_twins",),
    "firmware": ("unplugged_and_plugged_again", "brown_out_keeps_the_ram", "external_reset", "slave_hung_in_a_byte_is_clocked",
                 "main_loop_starved", "over_long_and_garbage", "lines_typed_behind_a_change_of_baud", "line_held_low",
                 "output_is_a_valid_stream", "two_runs_are_identical", "silent_int1", "no_sensor_is_told", "a_board_locked_out",
                 "line_is_idle", "start_after_the_watchdog", "divider_is_the_nearest", "led_on_d13", "start_waits_for_a_stop",
                 "line_with_a_damaged", "storm_on_int1_keeps", "int1_that_flickers", "storm_has_one_number", "random_bursts_of_edges",
                 "glitch_on_int1", "held_high_int1", "bus_fault_per_sample", "slow_wires_stretch", "sda_too_slow_for_the_master",
                 "i2c_100_is_slow", "settings_are_in_force", "race_on_a_sound_bus", "nothing_lost_100_hz_minus"),
    "hang/firmware": ("hung_loop_is_reset", "hung_filtering_is_reset", "test_resets.py:each_cause", "test_resets.py:watchdog_resets_twice",
                      "test_resets.py:a_loop_of_watchdog_resets"),
}
ONLY_CHIP = ("hal/avr/", "lib/filters/src/fx_avr.h", "lib/filters/src/fx_avr.c", "firmware/app/main.c")
HANG_TIMES, HANG_MIN_S = 10, 60


class Chip:
    """What the simulator says of a mutant."""

    def __init__(self, tree):
        self.clean, self.guard, self.ready = tree, threading.Lock(), False
        self.codes, self.seconds = {}, {}

    def image(self, name):
        return f"build/uno/{name}.elf"

    def make(self, tree, name):
        names = [name, "fx_twins_firmware"] if name == "fx_twins" else [name]
        return run(["make", "-s", "WARNINGS=-w", *map(self.image, names)], tree, 600)

    def code(self, tree, name):
        """What would be flashed."""
        target = ROOT / f"{tree.name}-{name.replace('/', '-')}.bin"
        status, said = run(["avr-objcopy", "-O", "binary", "-j", ".text", "-j", ".data", self.image(name), target], tree)
        if status != 0:
            raise Stop(f"{self.image(name)}: {said.strip()}")
        return target.read_bytes()

    def prepare(self):
        """Once: the unbroken programs, what they do, and how long a test takes."""
        with self.guard:
            if self.ready:
                return
            lists = ["build/uno/filters.txt", *(f"build/uno/{name}/filters.txt" for name in self.sets())]
            sets = run(["make", "-s", "build/sim/simrun", "flashtest_images", *lists], self.clean, 600)
            for name, words in PROGRAMS.items():
                status, said = self.make(self.clean, name)
                if status != 0 or sets[0] != 0:
                    raise Stop(f"{name} does not build as it stands: {(said or sets[1]).strip()[-200:]}")
                self.codes[name] = self.code(self.clean, name)
                for word in words:
                    began = time.monotonic()
                    if not self.passes(self.clean, word, 600):
                        raise Stop(f"the system test {word} fails on the unbroken code: python3 host_tests/system/system_tests.py {word}")
                    self.seconds[word] = time.monotonic() - began
            self.ready = True

    def sets(self):
        """The tests ask these lists which image holds a filter, whether it is run or not."""
        line = next(line for line in (self.clean / "mk/images.mk").read_text(encoding="utf-8").splitlines() if line.startswith("FILTER_SETS"))
        return line.split(":=")[1].split()[1:]

    @staticmethod
    def passes(tree, word, limit_s):
        file, _, word = word.rpartition(":")
        return run(["python3", "-B", f"host_tests/system/{file or 'system_tests.py'}", word], tree, limit_s)[0] == 0

    def verdict(self, mutant, worker):
        self.prepare()
        with self.guard:
            if not (worker.tree / "build/uno/firmware.elf").exists():
                for folder in ("uno", "sim"):
                    shutil.copytree(self.clean / "build" / folder, worker.tree / "build" / folder, symlinks=True, dirs_exist_ok=True)
        path = worker.tree / mutant.file
        whole = path.read_text(encoding="utf-8")
        path.write_text(mutant.apply(whole), encoding="utf-8")
        try:
            return self.programs(worker.tree)
        except Same:
            return "same", ""
        finally:
            path.write_text(whole, encoding="utf-8")

    def programs(self, tree):
        """A program that the mutant does not change judges nothing."""
        differs = False
        for name, words in PROGRAMS.items():
            if self.make(tree, name)[0] != 0:
                return "uncompiled", ""
            if self.code(tree, name) == self.codes[name]:
                continue
            differs = True
            for word in sorted(words, key=self.seconds.get):
                if not self.passes(tree, word, max(HANG_MIN_S, HANG_TIMES * self.seconds[word])):
                    return "killed", f"system:{word}"
        if not differs:
            raise Same
        return "survived", ""
