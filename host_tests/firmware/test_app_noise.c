/* `noise` and `odr` of the whole firmware, judged by the truth of the model: known noise, motion, clocks off. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "settings/settings.h"
#include "support/talk.h"
#include "support/test.h"

/*
 * 256 readings of known noise: the estimate's own deviation is 1 / sqrt(512) = 4.4 % of rms; 18 % are four times that.
 * R is 1.5 times the variance. Told after 256 samples, of every second, fourth, eighth from 200 Hz on.
 */
TEST(test_noise_at_any_rate)
{
    static const struct {
        const char *command;
        double rate_hz, seconds;
    } rates[] = { { "rate 12.5", 12.5, 20.48 }, { "rate 50", 50.0, 5.12 },   { "rate 100", 100.0, 2.56 },
                  { "rate 200", 200.0, 2.56 },  { "rate 400", 400.0, 2.56 }, { "rate 800", 800.0, 2.56 } };
    for (size_t i = 0; i < sizeof rates / sizeof rates[0]; i++) {
        talk_start_noisy(rates[i].rate_hz, 0.0);
        (void)talk_typed(rates[i].command, 1000.0);
        double begun_ms = hal_host_now_ms();
        size_t note = talk_typed("noise", rates[i].seconds * 1000.0 + 200.0);
        talk_assert_note("# noise: hold still", note);
        TEST_ASSERT_EQUAL_size_t(note + 4, board.note_count);
        TEST_ASSERT_DOUBLE_WITHIN(100.0 + 2000.0 / rates[i].rate_hz, rates[i].seconds * 1000.0,
                                  board.note_ms[note + 1] - begun_ms);
        for (size_t axis = 0; axis < 3; axis++) {
            char name = '?';
            double rms = 0.0;
            double r = 0.0;
            TEST_ASSERT_EQUAL_INT(
                3, sscanf(board.notes[note + 1 + axis], "# noise %c %lf LSB rms, R %lf LSB^2", &name, &rms, &r));
            TEST_ASSERT_EQUAL_CHAR("xyz"[axis], name);
            double truth = sqrt(1.5 * 1.5 + 1.0 / 12.0); /* and what rounding adds */
            TEST_ASSERT_DOUBLE_WITHIN(0.18 * truth, truth, rms);
            TEST_ASSERT_DOUBLE_WITHIN(0.02 + 2.0 * rms / 256.0, 1.5 * rms * rms, r);
        }
    }
}

/* The samples that it looks at are the rows' own: none is missing meanwhile. */
TEST(test_noise_takes_nothing_from_the_rows)
{
    talk_start_noisy(100.0, 0.0);
    size_t first = board.row_count;
    (void)talk_typed("noise", 3000.0);
    TEST_ASSERT_TRUE(board.row_count >= first + 299);
    for (size_t i = first; i < board.row_count; i++) {
        TEST_ASSERT_EQUAL_UINT(0, board.rows[i].flags);
        TEST_ASSERT_UINT32_WITHIN(2, 10000, board.rows[i].t_us - board.rows[i - 1].t_us);
    }
}

/* Turning by 4.5 LSB in the time of a measurement, or a knock of 128: refused; the knock at once. */
TEST(test_noise_of_a_board_that_moves_is_refused)
{
    for (int knock = 0; knock < 2; knock++) {
        stream_t stream = board_noisy_stream(6000, 100.0, 1.5, 13u);
        for (size_t k = 0; k < stream.count; k++) {
            double off = knock != 0 ? (k == 100 ? 140.0 : 0.0) : 6.0 * (double)k / 256.0;
            stream.rows[k].lsb[1] = (int16_t)(stream.rows[k].lsb[1] + (int)lround(off));
        }
        board_start(&stream, 0.0, 0);
        board_run_ms(500.0);
        size_t note = talk_typed("noise", 3000.0);
        talk_assert_note("# refused 8: moving", note + 1);
        TEST_ASSERT_EQUAL_size_t(note + 2, board.note_count);
        if (knock != 0) {
            TEST_ASSERT_TRUE(board.note_ms[note + 1] < 1200.0);
        }
    }
}

TEST(test_noise_ends_with_another_rate_and_goes_on_with_another_filter)
{
    static const struct {
        const char *command;
        bool ends_it;
    } talk[] = { { "rate 50", true },          { "range 4", true },  { "stop", true },        { "go", true },
                 { "filter {robust}", false }, { "every 3", false }, { "baud 250000", false } };
    for (size_t i = 0; i < sizeof talk / sizeof talk[0]; i++) {
        talk_start_noisy(100.0, 0.0);
        size_t note = talk_typed("noise", 500.0);
        (void)talk_typed(talk[i].command, 3000.0);
        TEST_ASSERT_EQUAL_size_t_MESSAGE(talk[i].ends_it, board_notes_with("# refused 9", note), talk[i].command);
        talk_assert_told_once(note, "noise");
    }
}

/* A sensor whose clock is 2 % fast, 3 % slow or right; the measurement itself is good to some ppm. */
TEST(test_odr_tells_the_measured_rate)
{
    static const struct {
        double ppm;
        const char *told;
    } clocks[] = { { 20000.0, "# odr 102.00 Hz, 2 % from 100 Hz" },
                   { -30000.0, "# odr 97.00 Hz, -3 % from 100 Hz" },
                   { 0.0, "# odr 100.00 Hz, 0 % from 100 Hz" } };
    for (size_t i = 0; i < 3; i++) {
        talk_start_noisy(100.0, clocks[i].ppm);
        size_t note = talk_typed("odr", 200.0);
        TEST_ASSERT_EQUAL_size_t(note + 1, board.note_count);
        TEST_ASSERT_EQUAL_STRING_LEN(clocks[i].told, board.notes[note], strlen(clocks[i].told));
    }
}

TEST(test_odr_is_not_known_before_sixteen_samples)
{
    talk_start_noisy(100.0, 0.0);
    (void)talk_typed("rate 12.5", 100.0);
    talk_assert_note("# odr: not measured yet", talk_typed("odr", 1000.0));
    board_run_ms(1000.0);
    talk_assert_note("# odr 12.50 Hz, 0 % from 12.5 Hz", talk_typed("odr", 200.0));
}
