#!/usr/bin/env python3
"""Tests of flights: their file, their simulation against the laws of motion, the frames of the navigation image, the judge."""
import contextlib
import io
import pathlib
import sys
import tempfile
import unittest

import numpy as np

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from tilt_case import run_tilt  # noqa: E402
from tilt import cli, numbers  # noqa: E402
from tilt.errors import TiltError  # noqa: E402
from tilt.navigation import exchange, flight, frames, judge, rotation, settings  # noqa: E402


def refused(text):
    """What is said of a file with this text."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "flight.csv"
        path.write_text(text, encoding="utf-8")
        try:
            flight.read(path)
        except TiltError as why:
            return str(why).replace(str(path), "F")
    return None


def run(*words):
    status, out, err = run_tilt(*words)
    return status, out + err


class Rotation(unittest.TestCase):
    def test_a_turn_is_what_its_matrix_says(self):
        """Rodrigues: exp of the cross-product matrix, by scipy."""
        from scipy.spatial.transform import Rotation as Reference
        random = np.random.default_rng(1)
        for _ in range(50):
            roll, pitch, heading = random.uniform(-3, 3), random.uniform(-1.5, 1.5), random.uniform(-3, 3)
            own = rotation.of_euler(roll, pitch, heading)
            reference = Reference.from_euler("ZYX", [heading, pitch, roll])
            np.testing.assert_allclose(rotation.matrix(own), reference.as_matrix(), atol=1e-12)
            np.testing.assert_allclose(rotation.euler(own), [roll, pitch, heading], atol=1e-9)

    def test_vector_between_has_the_thesis_sign(self):
        """C_true = (I - [mu x]) C_computed with mu minus this vector: a true attitude turned on by 1e-4 about down."""
        computed = rotation.of_euler(0.3, -0.2, 1.0)
        true = rotation.product(rotation.of_euler(0.0, 0.0, 1e-4), computed)
        np.testing.assert_allclose(rotation.vector_between(true, computed), [0, 0, 1e-4], atol=1e-9)
        np.testing.assert_allclose(rotation.vector_between(-true, computed), [0, 0, 1e-4], atol=1e-9)


class Simulated(unittest.TestCase):
    def test_motion_obeys_its_own_derivatives(self):
        t_s, step = np.linspace(1.0, 400.0, 300), 1e-4
        quaternion, velocity, position, acceleration, rate = flight.true_motion(t_s)
        before, after = flight.true_motion(t_s - step), flight.true_motion(t_s + step)
        np.testing.assert_allclose((after[2] - before[2]) / (2 * step), velocity, atol=1e-5)
        np.testing.assert_allclose((after[1] - before[1]) / (2 * step), acceleration, atol=1e-6)
        turned = rotation.product(rotation.inverse(before[0]), after[0])
        np.testing.assert_allclose(2 * turned[:, 1:] * np.sign(turned[:, :1]) / (2 * step), rate, atol=1e-6)
        np.testing.assert_allclose(np.linalg.norm(velocity, axis=1), 6.0)
        np.testing.assert_allclose(np.linalg.norm(quaternion, axis=1), 1.0)
        np.testing.assert_allclose(position[:, 2], 0.0)

    def test_sensors_say_the_truth_with_the_noise_of_the_thesis(self):
        wish = flight.Wish(seconds=400.0, drift=True, without=())
        said, truth = flight.measured(wish)
        steps = len(truth)
        np.testing.assert_allclose((said["gps"][:, :3] - truth[:, 4:7]).std(axis=0), 0.1, rtol=0.03)
        np.testing.assert_allclose((said["gps"][:, 3:] - truth[:, 7:]).std(axis=0), 5.0, rtol=0.03)
        np.testing.assert_allclose((said["down"] - truth[:, 9:]).std(), 1.0, rtol=0.03)
        rate = said["imu"][:, :3] - flight.true_motion((np.arange(1, steps + 1) - 0.5) * 0.01)[4]
        np.testing.assert_allclose(rate.std(axis=0), 6e-3, rtol=0.03)
        np.testing.assert_allclose(rate.mean(axis=0), flight.DRIFT_RPS, atol=4 * 6e-3 / np.sqrt(steps))
        still = flight.in_body(truth[:, :4], np.array([0.0, 0.0, 9.81]))
        self.assertLess(np.abs((said["imu"][:, 3:] + still).mean(axis=0)).max(), 0.13)  # what is left is the turn's 2 pi V / T

    def test_schedule_is_that_of_the_thesis(self):
        made = flight.simulated(flight.Wish())
        count = {kind: sum(row[0] == kind for row in made.rows) for kind in ("imu", "field", "gps", "down")}
        self.assertEqual(count, {"imu": 50000, "field": 5000, "gps": 160 + 101, "down": 500})
        self.assertEqual(made.gps_gaps(), [(160.0, 400.0)])
        times = [row[1] for row in made.rows if row[0] == "imu"]
        self.assertEqual((times[0], times[-1]), (10000, 500_000_000))

    def test_late_epochs_stand_where_they_arrive(self):
        made = flight.simulated(flight.Wish(seconds=5.0, late_us=120_000, without=()))
        imu = 0
        for kind, t_us, _ in made.rows:
            imu = t_us if kind == "imu" else imu
            if kind == "gps":
                self.assertEqual(imu - t_us, 120_000)

    def test_seed_decides(self):
        first, again, other = (flight.simulated(flight.Wish(seconds=3.0, seed=seed)) for seed in (4, 4, 5))
        self.assertEqual(first.rows, again.rows)
        self.assertNotEqual(first.rows, other.rows)


class File(unittest.TestCase):
    def test_comes_back_as_it_was_written(self):
        made = flight.simulated(flight.Wish(seconds=3.0))
        made.settings["gate"] = 4.0
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "flight.csv"
            flight.write(path, made, "two\nlines")
            back = flight.read(path)
        self.assertEqual([row[:2] for row in made.rows], [row[:2] for row in back.rows])
        for own, other in zip(made.rows, back.rows):
            np.testing.assert_array_equal(np.float32(own[2]), np.float32(other[2]))  # nine digits are single precision whole
        self.assertEqual(back.settings["gate"], 4.0)
        np.testing.assert_allclose(back.settings["quaternion"], made.settings["quaternion"], rtol=1e-8)
        self.assertEqual(back.truth_t_us, made.truth_t_us)

    def test_says_what_is_wrong_and_where(self):
        imu = "imu,10000,0,0,0,0,0,-9.81\n"
        for text, told in (
                ("", "F: no imu row"), ("# only words\n", "F: no imu row"), (imu + "baro,1,2\n", "F:2: unknown kind of row 'baro'"),
                (imu + "gps,1,2,3\n", "F:2: gps needs 8 fields, not 4"), ("imu,1.5,0,0,0,0,0,0\n", "F:1: t_us must be a whole number"),
                ("imu,-1,0,0,0,0,0,0\n", "F:1: t_us must be a whole number"), ("imu,4294967296,0,0,0,0,0,0\n", "F:1: t_us must be a whole number"),
                (imu + "down,5,high\n", "F:2: 'high' is not a number"), ("set,gates,1\n", "F:1: no setting 'gates'"),
                ("set,field,1,2\n", "F:1: field needs 3 numbers, not 2"), ("set\n", "F:1: set needs a name"),
                ("imu,\u00b2,0,0,0,0,0,0\n", "F:1: t_us must be a whole number"),
                (f"imu,{'9' * 5000},0,0,0,0,0,0\n", "F:1: t_us must be a whole number"),
                *((f"set,period_us,{text}\n", "F:1: period_us must be a whole number") for text in ("0.5", "nan", "inf", "-1", "1e12"))):
            self.assertIn(told, refused(text) or "taken", text)

    def test_what_a_sensor_says_is_for_the_filter_to_refuse(self):
        self.assertIsNone(refused("imu,10000,nan,inf,0,0,0,1e39\nimu,5000,0,0,0,0,0,0\n"))
        self.assertEqual(frames.single(1e39), frames.single(float("inf")))
        self.assertEqual(frames.single(-1e39), frames.single(float("-inf")))

    def test_binary_and_absent_files_are_told(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "flight.csv"
            path.write_bytes(b"\xff\xfe\x00imu")
            with self.assertRaisesRegex(TiltError, "not text"):
                flight.read(path)
            with self.assertRaisesRegex(TiltError, "No such file"):
                flight.read(path.with_name("other.csv"))


class Frames(unittest.TestCase):
    # Cheshire and Baker's examples and the edges of a run
    KNOWN = ((b"\0", b"\x01\x01"), (b"\0\0", b"\x01\x01\x01"), (b"\x11\x22\0\x33", b"\x03\x11\x22\x02\x33"), (b"\x11\0\0\0", b"\x02\x11\x01\x01\x01"),
             (bytes(range(1, 255)), b"\xff" + bytes(range(1, 255)) + b"\x01"))

    def test_stuffing_is_the_papers(self):
        for plain, wanted in self.KNOWN:
            self.assertEqual(frames.stuffed(plain), wanted)
            self.assertEqual(frames.unstuffed(wanted), plain)

    def test_crc_has_its_check_value(self):
        self.assertEqual(frames.crc(b"123456789"), b"\xb1\x29")

    def test_each_damaged_byte_is_seen(self):
        whole = frames.frame(frames.row_record(3, "gps", 77, (1, 2, 3, 4, 5, 6)))
        for place in range(len(whole) - 1):
            for bit in range(8):
                damaged = bytearray(whole)
                damaged[place] ^= 1 << bit
                reader = frames.Reader()
                self.assertEqual(reader.feed(bytes(damaged)), [])

    def test_records_have_the_lengths_of_the_protocol(self):
        lengths = {"P": 27, "S": 6, "I": 31, "G": 30, "A": 10, "M": 18, "V": 2, "C": 2}
        made = flight.simulated(flight.Wish(seconds=3.0))
        seen = set()
        for record in exchange.records(made, {}):
            plain = frames.record_of(record.data[:-1])
            self.assertEqual(len(plain), lengths[chr(plain[0])])
            self.assertEqual(record.data.count(0), 1)
            seen.add(chr(plain[0]))
        self.assertEqual(seen, set(lengths))

    def test_sequence_numbers_go_on_and_the_parameters_are_in_the_header_s_order(self):
        made = flight.simulated(flight.Wish(seconds=3.0))
        plain = [frames.record_of(record.data[:-1]) for record in exchange.records(made, {"gate": 4.5})]
        self.assertEqual([record[1] for record in plain], [number % 256 for number in range(len(plain))])
        numbers = np.frombuffer(b"".join(record[3:] for record in plain[:5]), "<f4")
        names = [name for name in settings.DEFAULTS for _ in range(settings.width(name))]
        self.assertEqual(len(numbers), 30)
        self.assertEqual(numbers[names.index("gate")], 4.5)
        self.assertEqual(numbers[names.index("sigma_gps_position_m")], 5.0)
        header = pathlib.Path("nav/lib/nav.h").read_text(encoding="utf-8")
        config = header[header.index("nav_state_t start;"):header.index("} nav_config_t")]
        places = [config.index(name) for name in list(settings.DEFAULTS)[4:]]
        self.assertEqual(places, sorted(places))


class Due(unittest.TestCase):
    """When records are sent."""

    def dues(self, change=lambda t_us: t_us, seconds=4.0, slower=1):
        made = flight.simulated(flight.Wish(seconds=seconds))
        made.rows = [(kind, change(t_us * slower) % (1 << 32), values) for kind, t_us, values in made.rows]
        return np.array([record.due_us for record in exchange.records(made, {}) if record.kind == "imu"])

    def test_by_the_imu_s_times_over_the_wrap_of_the_clock(self):
        wanted = np.arange(400) * 10_000
        np.testing.assert_array_equal(self.dues(), wanted)
        np.testing.assert_array_equal(self.dues(lambda t_us: t_us + (1 << 32) - 2_000_000), wanted)

    def test_behind_half_a_round_of_the_clock(self):
        np.testing.assert_array_equal(self.dues(slower=1000), np.arange(400) * 10_000_000)

    def test_one_time_that_leaps_is_not_waited_for(self):
        for wrong in (1_000_000_000, 5_000, (1 << 32) - 1_000_000_000):
            for place in (10_000, 20_000, 2_000_000, 3_990_000, 4_000_000):
                dues = self.dues(lambda t_us, place=place, wrong=wrong: wrong if t_us == place else t_us)
                self.assertLessEqual(np.abs(dues - np.arange(400) * 10_000).max(), 20_000, (wrong, place))

    def test_a_flight_of_one_record(self):
        for steps in (1, 2):
            made = flight.Flight(rows=[("imu", 10_000 * step, (0.0,) * 6) for step in range(steps)])
            self.assertEqual([record.due_us for record in exchange.records(made, {}) if record.kind == "imu"], [0, 10_000][:steps])


class Pairs(unittest.TestCase):
    """Answers find their records by number and type, whatever the line lost."""
    SENT = exchange.records(flight.simulated(flight.Wish(seconds=8.0)), {})

    def answers(self, lost=(), refused=(), broken=()):
        """The board's, with these records lost, refused as out of range, and a broken frame told before these."""
        for place, record in enumerate(self.SENT):
            if place in broken:
                yield frames.Answer(0, "", 32, 0, 0)
            if place not in lost:
                yield frames.Answer(record.sequence, chr(frames.record_of(record.data[:-1])[0]), 6 if place in refused else 0, 0, 0)

    def refusals(self, **line):
        found = exchange.refusals(self.SENT, exchange.Outcome(answers=list(self.answers(**line))))
        return [(record and self.SENT.index(record), frames.answer_text(answer.code)) for record, answer in found]

    def test_a_lost_frame_shifts_none(self):
        self.assertGreater(len(self.SENT), 800)
        self.assertEqual(self.refusals(refused=(300, 700)), [(300, "out of range"), (700, "out of range")])
        self.assertEqual(self.refusals(lost=(20, 299, *range(400, 500)), refused=(300, 700)), [(300, "out of range"), (700, "out of range")])

    def test_a_lost_zero_byte_makes_one_broken_frame_of_two(self):
        self.assertEqual(self.refusals(lost=(50, 51), broken=(51,), refused=(60,)), [(None, "broken frame"), (60, "out of range")])

    def test_a_second_answer_to_one_record_is_that_record_s(self):
        once = list(self.answers())
        again = exchange.Outcome(answers=[*once[:501], frames.Answer(once[500].sequence, once[500].kind, 35, 0, 0), *once[501:]])
        self.assertEqual([(record, answer.code) for record, answer in exchange.refusals(self.SENT, again)], [(self.SENT[500], 35)])
        self.assertTrue(all(record for record, _ in exchange.answered(self.SENT, again.answers)))

    def test_an_answer_of_another_type_is_no_record_s(self):
        pairs = exchange.answered(self.SENT, [frames.Answer(300 & 0xFF, "V", 0, 0, 0), frames.Answer(0, "?", 33, 0, 0)])
        self.assertEqual([record for record, _ in pairs], [None, None])

    def test_start_that_was_lost_is_told_apart_from_one_that_is_refused(self):
        def check(*codes):
            answers = [frames.Answer(number, "PPPPPS"[number], code, 0, 0) for number, code in enumerate(codes) if code is not None]
            later = [frames.Answer(record.sequence, "I", 36 if any(code != 0 for code in codes) else 0, 0, 0) for record in self.SENT[6:9]]
            exchange.check_start(self.SENT, exchange.Outcome(answers=answers + later))

        check(0, 0, 0, 0, 0, 0)
        with self.assertRaisesRegex(TiltError, "start refused: a setting is out of range"):
            check(0, 0, 0, 0, 0, 37)
        with self.assertRaisesRegex(TiltError, "the board answered 5 of its 6 start frames, .* lost on the line"):
            check(0, 0, None, 0, 0, 37)
        with self.assertRaisesRegex(TiltError, "the board answered 5 of its 6 start frames, .* lost on the line"):
            check(0, 0, 0, 0, 0, None)


class Judge(unittest.TestCase):
    def test_errors_are_true_minus_computed_at_common_times(self):
        made = flight.simulated(flight.Wish(seconds=60.0, without=((50.0, 55.0),)))
        outcome = exchange.Outcome()
        turned = rotation.of_euler(0.0, 0.0, np.radians(2.0))
        for t_us, true in zip(made.truth_t_us[::2], made.truth[::2]):
            numbers = (*rotation.product(turned, np.array(true[:4])), *(np.array(true[4:7]) - [0, 1, 0]),
                       *(np.array(true[7:]) - [3, 0, 4]), 0, 0, 0)
            outcome.states.append(frames.State(t_us, numbers))
        found = judge.errors(made, outcome)
        self.assertEqual(len(found.t_s), len(made.truth[::2]))
        np.testing.assert_allclose(found.euler_deg[:, 2], -2.0, atol=1e-6)
        np.testing.assert_allclose(found.attitude_deg[:, 2], -2.0, atol=1e-3)
        np.testing.assert_allclose(found.velocity_mps, [[0, 1, 0]] * len(found.t_s), atol=1e-9)
        np.testing.assert_allclose(np.linalg.norm(found.position_m, axis=1), 5.0)
        self.assertEqual([row[0] for row in judge.intervals(made, 60.0)], ["GPS", "no GPS", "GPS"])


    def test_the_clock_may_wrap_in_flight(self):
        made = flight.simulated(flight.Wish(seconds=20.0, without=((8.0, 14.0),)))
        late = flight.simulated(flight.Wish(seconds=20.0, without=((8.0, 14.0),)))
        shift = (1 << 32) - 9_000_000
        late.rows = [(kind, (t_us + shift) % (1 << 32), values) for kind, t_us, values in late.rows]
        late.truth_t_us = [(t_us + shift) % (1 << 32) for t_us in late.truth_t_us]
        self.assertAlmostEqual(late.seconds, made.seconds)
        np.testing.assert_allclose(late.gps_gaps(), np.array(made.gps_gaps()) + shift * 1e-6)
        outcome = exchange.Outcome(states=[frames.State(t_us, (*true, 0, 0, 0)) for t_us, true in zip(late.truth_t_us, late.truth)])
        found = judge.errors(late, outcome)
        self.assertEqual(len(found.t_s), len(late.truth))
        np.testing.assert_allclose(found.t_s[-1] - found.t_s[0], 19.9)


class Command(unittest.TestCase):
    def test_flight_refuses_what_makes_no_sense(self):
        for words, told in ((("--seconds", 1), "--seconds 1: give 2 to 4000"), (("--gps-late", -1), "--gps-late -1: give 0"),
                            (("--without-gps", "10-20"), "give A:B"), (("--without-gps", "1..2:3"), "give A:B"),
                            (("--without-gps", "8:3"), "ends before it begins"), (("--seed", -1), "--seed -1: give 0 or more")):
            with tempfile.TemporaryDirectory() as folder:
                status, said = run("flight", pathlib.Path(folder) / "never-written.csv", *words)
                self.assertEqual(list(pathlib.Path(folder).iterdir()), [])
            self.assertEqual(status, 2)
            self.assertIn(told, said)

    def test_numbers_are_written_plainly(self):
        """1_0 and digits of other scripts are numbers to Python, and slips here."""
        for text in ("1_0", "\u0661", "0x10", "", "1e", "1 0", "--1", "1,0,0"):
            for words in (("flight", "x.csv", f"--seconds={text}"), ("flight", "x.csv", f"--seed={text}"), ("flight", "x.csv", f"--gps-late={text}"),
                          ("nav", "--board", "pc", f"--every={text}"), ("nav", "--board", "pc", f"--states={text}")):
                with self.assertRaises(SystemExit) as ended, contextlib.redirect_stderr(io.StringIO()) as said:
                    cli.main(list(words))
                self.assertEqual(ended.exception.code, 2)
                self.assertRegex(said.getvalue(), rf"tilt (flight|nav): --\S+: '{text}' is not a (whole )?number")
            self.assertEqual(run("nav", "--board", "pc", "--set", f"field={text},1,{text}")[0], 2)
        self.assertIn("--set needs NAME=NUMBER", run("nav", "--board", "pc", "--set", "gate=1_0")[1])
        self.assertIn("give A:B", run("flight", "x.csv", "--without-gps", "1:\u0663")[1])
        self.assertIn("F:1: '1_0' is not a number", refused("set,gate,1_0\n"))
        self.assertIn("F:1: '0_1' is not a number", refused("imu,10000,0,0,0_1,0,0,0\n"))
        self.assertIn("F:1: t_us must be a whole number", refused("imu,1_0,0,0,0,0,0,0\n"))
        for text, value in (("1", 1.0), ("-.5", -0.5), ("+1.", 1.0), ("1E-3", 1e-3), (" 2 ", 2.0), ("-INF", -np.inf)):
            self.assertEqual(numbers.real(text), value)
        self.assertTrue(np.isnan(numbers.real("nan")))

    def test_nav_refuses_before_the_flight_what_it_could_not_write_behind_it(self):
        for words, told in ((("-o", "/no/such/x.csv"), "no folder /no/such"), (("--plot", "/no/such/x.png"), "no folder"),
                            (("--plot", "x.txt"), "unknown suffix: use one of")):
            status, said = run("nav", "--board", "pc", *words)
            self.assertEqual(status, 2)
            self.assertIn(told, said)
            self.assertNotIn("of flight in", said)

    def test_nav_refuses_settings_that_are_none(self):
        for words, told in ((("--set", "gate"), "--set needs NAME=NUMBER"), (("--set", "gates=1"), "no setting 'gates'"),
                            (("--set", "field=1"), "field needs 3 numbers"), (("--every", 0), "--every 0: give 1 or more"),
                            (("no-such.csv",), "No such file")):
            status, said = run("nav", "--board", "pc", *words)
            self.assertEqual(status, 2, said)
            self.assertIn(told, said)


if __name__ == "__main__":
    from unity_line import main
    main()
