/* The verdict on a reading: what each byte and bit of it must be, and what is counted. */
#include <math.h>
#include <string.h>

#include "adxl345.h"
#include "adxl345_integrity.h"
#include "adxl345_table.h"
#include "support/documented_limits.h"
#include "support/random.h"
#include "support/test.h"

enum { PATTERN = 0x8A };

/* No shift turns the neighbours of FIFO_CTL into its pattern: z's sign byte before it (16 g), FIFO_STATUS after it. */
TEST(test_no_shift_keeps_the_pattern)
{
    TEST_ASSERT_EQUAL_HEX8(PATTERN, TABLE_FIFO_CTL);
    for (unsigned by = 1; by < 8; by++) {
        for (int high = -16; high < 16; high++) {
            TEST_ASSERT_NOT_EQUAL(PATTERN, (uint8_t)((unsigned)high << (8 - by) | PATTERN >> by));
        }
        for (unsigned status = 0; status <= 33; status++) {
            TEST_ASSERT_NOT_EQUAL(PATTERN, (uint8_t)(PATTERN << by | status >> (8 - by)));
        }
    }
}

static uint8_t format; /* of the range in force */

static reading_t judged(const int16_t lsb[3], unsigned byte, uint8_t flipped)
{
    uint8_t reading[READING_BYTES] = { 0x83, format, 0, 0, 0, 0, 0, 0, PATTERN, 0 };
    static const int16_t last[] = { 1, -2, 256 };
    int16_t out[3] = { 0 };
    for (unsigned i = 0; i < 6; i++) {
        reading[READING_DATA + i] = (uint8_t)((uint16_t)lsb[i / 2] >> (i % 2 * 8));
    }
    reading[byte] ^= flipped;
    reading_t verdict = adxl345_integrity_judge(reading, out, last);
    if (verdict == READING_GOOD && flipped == 0) {
        TEST_ASSERT_EQUAL_INT16_ARRAY(lsb, out, 3);
    }
    return verdict;
}

static void start(uint8_t range_g, bool self_test)
{
    adxl345_config_t config = { 1000, range_g, self_test, 0 };
    adxl345_integrity_start(&config);
}

/* What power-on leaves in the two bytes that an empty sensor is asked for; zeros alone are a line that is low. */
TEST(test_registers_after_power_on)
{
    uint8_t reading[READING_BYTES] = { 0x02, 0, 0, 0, 0, 0, 0, 0, PATTERN, 0 }; /* from the third on those before */
    static const int16_t last[] = { 1, -2, 256 };
    int16_t out[3];
    start(16, false);
    TEST_ASSERT_EQUAL(READING_RESET, adxl345_integrity_judge(reading, out, last));
    reading[READING_SOURCE] = 0;
    TEST_ASSERT_EQUAL(READING_BAD, adxl345_integrity_judge(reading, out, last));
    reading[READING_SOURCE] = 0x02;
    reading[READING_FORMAT] = 0x0A;
    TEST_ASSERT_EQUAL(READING_BAD, adxl345_integrity_judge(reading, out, last));
    reading[READING_SOURCE] = 0x82; /* no sensor at rest has a sample ready */
    reading[READING_FORMAT] = 0;
    TEST_ASSERT_EQUAL(READING_BAD, adxl345_integrity_judge(reading, out, last));
}

/* A reading is of the self-test if it was asked for, and only then. */
TEST(test_a_reading_with_the_other_self_test_bit_is_no_reading)
{
    static const int16_t lsb[] = { 100, -200, 300 };
    for (unsigned asked = 0; asked < 2; asked++) {
        for (unsigned set = 0; set < 2; set++) {
            start(16, asked != 0);
            format = (uint8_t)(0x0B | (set << 7));
            TEST_ASSERT_EQUAL(asked == set ? READING_GOOD : READING_BAD, judged(lsb, 0, 0));
        }
    }
}

/* Bits 15 down to the range's sign bit agree: 16 g has 13 bits, 2 g has 10 (full resolution, p. 27). */
TEST(test_a_sign_bit_that_disagrees_is_no_reading)
{
    static const uint8_t ranges_g[] = { 2, 4, 8, 16 };
    for (unsigned r = 0; r < 4; r++) {
        int16_t rail = (int16_t)(ranges_g[r] * 256);
        start(ranges_g[r], false);
        format = (uint8_t)(0x08 + r);
        for (unsigned axis = 0; axis < 3; axis++) {
            const int16_t ends[] = { (int16_t)-rail, -1, 0, (int16_t)(rail - 1) };
            for (unsigned e = 0; e < 4; e++) {
                int16_t lsb[3] = { 1, -2, 3 };
                lsb[axis] = ends[e];
                TEST_ASSERT_EQUAL(READING_GOOD, judged(lsb, 0, 0));
                for (unsigned bit = 9 + r; bit < 16; bit++) {
                    reading_t verdict = judged(lsb, READING_DATA + 2 * axis + 1, (uint8_t)(1u << (bit - 8)));
                    TEST_ASSERT_EQUAL(READING_BAD, verdict);
                }
            }
        }
    }
}

/* One past the upper rail, while the other axes are at the lower one and set no bit beside it. */
TEST(test_a_value_beyond_the_range_is_no_reading)
{
    for (uint8_t code = 0; code < 4; code++) {
        uint8_t range_g = (uint8_t)(2u << code);
        int16_t rail = (int16_t)(range_g * 256);
        start(range_g, false);
        format = (uint8_t)(0x08 + code);
        for (unsigned axis = 0; axis < 3; axis++) {
            int16_t lsb[3] = { (int16_t)-rail, (int16_t)-rail, (int16_t)-rail };
            TEST_ASSERT_EQUAL(READING_GOOD, judged(lsb, 0, 0));
            lsb[axis] = rail;
            TEST_ASSERT_EQUAL(READING_BAD, judged(lsb, 0, 0));
        }
    }
}

TEST(test_every_single_flip_of_pattern_and_status)
{
    static const int16_t lsb[] = { 1, -2, 256 };
    start(16, false);
    format = 0x0B;
    for (unsigned bit = 0; bit < 8; bit++) {
        TEST_ASSERT_EQUAL(READING_BAD, judged(lsb, READING_FIFO_CTL, (uint8_t)(1u << bit)));
        /* up to 33 samples wait: bits 0 to 5 tell nothing */
        TEST_ASSERT_EQUAL(bit < 6 ? READING_GOOD : READING_BAD, judged(lsb, READING_FIFO_STATUS, (uint8_t)(1u << bit)));
    }
    TEST_ASSERT_EQUAL(READING_BAD, judged(lsb, READING_FIFO_STATUS, 34));
    TEST_ASSERT_EQUAL(READING_GOOD, judged(lsb, READING_FIFO_STATUS, 33));
    for (unsigned bit = 0; bit < 8; bit++) {
        TEST_ASSERT_EQUAL(READING_BAD, judged(lsb, READING_FORMAT, (uint8_t)(1u << bit)));
    }
    TEST_ASSERT_EQUAL(READING_BAD, judged(lsb, READING_FIFO_CTL, PATTERN));
    TEST_ASSERT_EQUAL(READING_BAD, judged(lsb, READING_FORMAT, format));
}

/* An empty sensor is asked for two bytes: the others are those of the reading before it, whatever that was. */
TEST(test_an_empty_reading_has_the_right_format)
{
    uint8_t reading[READING_BYTES] = { 0, 0, 0xFF, 0x7F, 0xFF, 0x7F, 0xFF, 0x7F, 0xFF, 0xFF };
    static const int16_t last[] = { 1, -2, 256 };
    int16_t out[3];
    start(16, false);
    for (unsigned source = 0; source < 0x80; source++) {
        for (unsigned is = 1; is <= UINT8_MAX; is++) {
            reading[READING_SOURCE] = (uint8_t)source;
            reading[READING_FORMAT] = (uint8_t)is;
            TEST_ASSERT_EQUAL(is == 0x0B ? READING_EMPTY : READING_BAD, adxl345_integrity_judge(reading, out, last));
        }
    }
}

TEST(test_ones_on_all_axes_are_nobody)
{
    static const int16_t nobody[] = { -1, -1, -1 };
    start(16, false);
    TEST_ASSERT_EQUAL(READING_BAD, judged(nobody, 0, 0));
    for (unsigned byte = READING_DATA; byte < READING_FIFO_CTL; byte++) {
        TEST_ASSERT_EQUAL(READING_GOOD, judged(nobody, byte, 1));
    }
}

TEST(test_counters_saturate)
{
    static const int16_t lsb[] = { 1, -2, 256 };
    adxl345_readings_t readings;
    adxl345_init();
    start(16, false);
    for (unsigned i = 0; i < 65536; i++) {
        (void)judged(lsb, READING_FIFO_CTL, 1);
        adxl345_integrity_int1_lied();
        (void)judged(lsb, READING_SOURCE, 0x02); /* Overrun is set in 0x83 already */
    }
    adxl345_readings(&readings);
    TEST_ASSERT_EQUAL_UINT16(UINT16_MAX, readings.failed);
    TEST_ASSERT_EQUAL_UINT16(UINT16_MAX, readings.empty);
    TEST_ASSERT_EQUAL_UINT16(UINT16_MAX, readings.overruns);
}

/* Flag 64 of the row after a reading that failed, and of no other (docs/protocol.md). */
TEST(test_a_failed_reading_is_marked_once)
{
    static const int16_t lsb[] = { 1, -2, 256 };
    adxl345_init();
    start(16, false);
    format = 0x0B;
    TEST_ASSERT_EQUAL(READING_GOOD, judged(lsb, 0, 0));
    TEST_ASSERT_EQUAL_HEX8(0, adxl345_marks());
    TEST_ASSERT_EQUAL(READING_BAD, judged(lsb, READING_FIFO_CTL, 1));
    TEST_ASSERT_EQUAL_HEX8(64, adxl345_marks());
    TEST_ASSERT_EQUAL_HEX8(0, adxl345_marks());
    TEST_ASSERT_EQUAL(READING_BAD, judged(lsb, READING_FIFO_CTL, 1));
    adxl345_init();
    TEST_ASSERT_EQUAL_HEX8(0, adxl345_marks());
}

/* However many follow the third, they are torn: none of them says that the configuration is lost. */
TEST(test_torn_readings_stay_torn)
{
    static const int16_t lsb[] = { 1, -2, 256 };
    adxl345_init();
    start(16, false);
    format = 0x0B;
    for (unsigned i = 1; i <= 300; i++) {
        TEST_ASSERT_EQUAL(READING_BAD, judged(lsb, READING_FIFO_CTL, 1));
        TEST_ASSERT_EQUAL(i >= LIMIT_TORN ? ADXL345_FAULT_TORN : ADXL345_FAULT_NONE, adxl345_integrity_fault());
    }
}

/*
 * INT1 is called stuck by three bursts in a row that met no sample, of which those before adxl345_integrity_forget are
 * none.
 */
TEST(test_the_third_empty_reading_is_of_an_int1_that_is_stuck)
{
    start(16, false);
    format = 0x0B;
    for (unsigned times = 0; times < 2; times++) {
        adxl345_integrity_forget();
        for (unsigned i = 1; i <= 300; i++) {
            adxl345_integrity_int1_lied();
            TEST_ASSERT_EQUAL(i >= LIMIT_EMPTY, adxl345_integrity_int1_stuck());
        }
    }
}

/* 32 good readings that leave INT1 low: the line is trusted again, and three more empty readings make it stuck. */
TEST(test_an_int1_that_was_stuck_is_trusted_anew)
{
    static const int16_t lsb[] = { 1, -2, 256 };
    start(16, false);
    format = 0x0B;
    adxl345_integrity_forget();
    for (unsigned times = 0; times < 2; times++) {
        for (unsigned i = 1; i <= LIMIT_EMPTY; i++) {
            TEST_ASSERT_FALSE(adxl345_integrity_int1_stuck());
            adxl345_integrity_int1_lied();
        }
        for (unsigned i = 1; i <= LIMIT_TRUSTED; i++) {
            TEST_ASSERT_TRUE(adxl345_integrity_int1_stuck());
            TEST_ASSERT_EQUAL(READING_GOOD, judged(lsb, 0, 0));
        }
    }
    TEST_ASSERT_FALSE(adxl345_integrity_int1_stuck());
}

/* The tenth equal triplet in a row and all that follow it, until one differs in one axis. */
TEST(test_the_tenth_equal_reading_is_stuck)
{
    for (unsigned axis = 0; axis < 3; axis++) {
        uint8_t reading[READING_BYTES] = { 0x80, 0x0B, 1, 0, 2, 0, 3, 0, PATTERN, 0 };
        int16_t lsb[2][3] = { { 0 }, { 0 } };
        adxl345_integrity_forget();
        start(16, false);
        for (unsigned i = 1; i <= 300; i++) {
            TEST_ASSERT_EQUAL(READING_GOOD, adxl345_integrity_judge(reading, lsb[i % 2], lsb[(i + 1) % 2]));
            TEST_ASSERT_EQUAL(i >= LIMIT_STUCK_SAMPLES, adxl345_integrity_stuck());
        }
        reading[READING_DATA + 2 * axis]++;
        TEST_ASSERT_EQUAL(READING_GOOD, adxl345_integrity_judge(reading, lsb[1], lsb[0]));
        TEST_ASSERT_FALSE(adxl345_integrity_stuck());
    }
}

/* A sensor that was stuck, and is another now: its own ten readings count, whether they are as before or not. */
TEST(test_a_sensor_that_may_be_another_has_ten_readings_of_its_own)
{
    for (unsigned differs = 0; differs < 2; differs++) {
        uint8_t reading[READING_BYTES] = { 0x80, 0x0B, 1, 0, 2, 0, 3, 0, PATTERN, 0 };
        int16_t lsb[2][3] = { { 0 }, { 0 } };
        adxl345_integrity_forget();
        start(16, false);
        for (unsigned i = 1; i <= 30; i++) {
            (void)adxl345_integrity_judge(reading, lsb[i % 2], lsb[(i + 1) % 2]);
        }
        TEST_ASSERT_TRUE(adxl345_integrity_stuck());
        adxl345_integrity_forget();
        start(16, false);
        reading[READING_DATA] = (uint8_t)(reading[READING_DATA] + differs);
        for (unsigned i = 1; i <= 12; i++) {
            TEST_ASSERT_EQUAL(READING_GOOD, adxl345_integrity_judge(reading, lsb[i % 2], lsb[(i + 1) % 2]));
            TEST_ASSERT_EQUAL(i >= LIMIT_STUCK_SAMPLES, adxl345_integrity_stuck());
        }
    }
}

/* The chance of a code for a true value that lies offset_lsb beside it. */
static double code_chance(double sigma_lsb, double offset_lsb)
{
    double scale = 1.0 / (sigma_lsb * sqrt(2.0));
    return 0.5 * (erf((offset_lsb + 0.5) * scale) - erf((offset_lsb - 0.5) * scale));
}

/* That so many readings of all axes at rest are equal, for the most unfavourable true values. */
static double equal_chance(const double sigma_lsb[3], unsigned readings)
{
    double chance = 1.0;
    for (unsigned axis = 0; axis < 3; axis++) {
        double worst = 0.0;
        for (double fraction = 0.0; fraction <= 0.5; fraction += 0.01) {
            double sum = 0.0;
            for (int code = -8; code <= 8; code++) {
                sum += pow(code_chance(sigma_lsb[axis], code - fraction), readings);
            }
            worst = fmax(worst, sum);
        }
        chance *= worst;
    }
    return chance;
}

/* By the data sheet (p. 4) and by the quietest recording; the sum over codes is judged by what is drawn below. */
static const double data_sheet_lsb[] = { 0.75, 0.75, 1.1 };

TEST(test_the_bound_of_a_false_alarm)
{
    static const double recorded_lsb[] = { 0.72, 0.78, 0.99 };
    const unsigned readings = ADXL345_STUCK_REPEATS + 1u;
    TEST_ASSERT_TRUE(equal_chance(data_sheet_lsb, readings) < 2.4e-11);
    TEST_ASSERT_TRUE(equal_chance(recorded_lsb, readings) < 8e-11);
    TEST_ASSERT_TRUE(equal_chance(recorded_lsb, readings - 1u) > 8e-11);
    TEST_ASSERT_DOUBLE_WITHIN(0.1e-9, 3.3e-9, equal_chance(data_sheet_lsb, 8));
}

/* Ten million samples at rest on whole codes: 2.3e-11 each. Of four equal ones there are as many as derived. */
TEST(test_noise_is_never_stuck)
{
    enum { SAMPLES = 10000000 };
    uint8_t reading[READING_BYTES] = { 0x80, 0x0B, 0, 0, 0, 0, 0, 0, PATTERN, 0 };
    int16_t lsb[2][3] = { { 0 }, { 0 } };
    unsigned run = 0;
    unsigned fours = 0;
    test_random_t random;
    random_seed(&random, 20261122u);
    adxl345_integrity_forget();
    start(16, false);
    for (unsigned i = 0; i < SAMPLES; i++) {
        for (unsigned axis = 0; axis < 3; axis++) {
            uint16_t word = (uint16_t)(100 + lround(data_sheet_lsb[axis] * random_normal(&random)));
            reading[READING_DATA + 2 * axis] = (uint8_t)word;
            reading[READING_DATA + 2 * axis + 1] = (uint8_t)(word >> 8);
        }
        (void)adxl345_integrity_judge(reading, lsb[i % 2], lsb[(i + 1) % 2]);
        TEST_ASSERT_FALSE(adxl345_integrity_stuck());
        run = memcmp(lsb[0], lsb[1], sizeof lsb[0]) == 0 ? run + 1 : 0;
        fours += run >= 3;
    }
    double expected = SAMPLES * equal_chance(data_sheet_lsb, 4);
    TEST_ASSERT_DOUBLE_WITHIN(8.0 * sqrt(expected), expected, fours);
}
