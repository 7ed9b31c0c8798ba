/* One axis of the sample path (lib/tilt/src/tilt_axis.h): noise is estimated once, by the law or beside it. */
#include "filter_list.h"
#include "support/filters.h"
#include "support/random.h"
#include "support/roles.h"
#include "support/test.h"
#include "tilt_axis.h"

#include <math.h>

enum { RATE_DHZ = 1000, RAIL_LSB = 4095, LEVEL_LSB = 200, SAMPLES = 2000, HELD = 20 };

static test_random_t noise_source;
static tilt_axis_t axis;

void setUp(void)
{
    random_seed(&noise_source, 7);
}

static void begin(filter_kind_t kind, bool identify)
{
    filter_config_t config = filter_defaults(filter_listed(kind), RATE_DHZ);
    uint8_t place = parameter_named(kind, "identify");
    if (place < FILTER_PARAMETERS_MAX) {
        config.value[place] = identify ? 1 : 0;
    }
    TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(&axis.filter, filter_listed(kind), &config));
    tilt_axis_begin(&axis, RATE_DHZ, false);
}

/* So many samples of a resting sensor with this sigma, in whole LSB. */
static void rest(double sigma_lsb)
{
    for (int i = 0; i < SAMPLES; i++) {
        int16_t lsb = as_sample(LEVEL_LSB + sigma_lsb * random_normal(&noise_source));
        (void)tilt_axis_update(&axis, lsb, RAIL_LSB, false);
    }
}

static void hold(void)
{
    for (int i = 0; i < HELD; i++) {
        (void)tilt_axis_missing(&axis);
    }
    TEST_ASSERT_EQUAL_UINT8(1, axis.away);
}

/* The floor of R at 100 Hz is 3 LSB^2; 1.5 x 8^2 are 96. */
TEST(test_noise_is_estimated_beside_a_law_only_where_it_does_not_itself)
{
    int own = 0;
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        begin((filter_kind_t)kind, true);
        uint32_t floor_lsb2_q8 = filter_noise_r_lsb2_q8(&axis.noise);
        rest(8.0);
        if (filter_own_noise_lsb2_q8(&axis.filter) != 0) {
            own++;
            TEST_ASSERT_EQUAL_UINT32(floor_lsb2_q8, filter_noise_r_lsb2_q8(&axis.noise));
        } else {
            TEST_ASSERT_GREATER_THAN_UINT32(16 * floor_lsb2_q8, filter_noise_r_lsb2_q8(&axis.noise));
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(0, own);
}

/* R goes from the data sheet's floor to the estimate of 1.5 x 8^2: the gain becomes that of a noisier sensor. */
TEST(test_the_filter_is_given_the_estimate)
{
    begin(plain_kind(), false);
    rest(0.5);
    uint16_t quiet_uq16 = axis.filter.gain_uq16;
    rest(8.0);
    TEST_ASSERT_LESS_THAN_UINT16(quiet_uq16 / 4U * 3U, axis.filter.gain_uq16);
}

TEST(test_a_law_that_does_not_identify_takes_the_estimate)
{
    begin(DEFAULT_KIND, false);
    TEST_ASSERT_EQUAL_UINT32(0, filter_own_noise_lsb2_q8(&axis.filter));
    rest(8.0);
    TEST_ASSERT_GREATER_THAN_UINT32(16 * 3 * 256, filter_noise_r_lsb2_q8(&axis.noise));
}

/* 1.5 variances, as the estimate of noise.h; the law's mean of sizes over about 16 terms has a sigma of a fifth. */
TEST(test_the_law_reports_the_r_of_the_noise)
{
    for (double sigma_lsb = 2.0; sigma_lsb < 70.0; sigma_lsb *= 2.0) {
        double sum = 0.0;
        begin(DEFAULT_KIND, true);
        for (int i = 0; i < 20; i++) {
            rest(sigma_lsb);
            sum += filter_own_noise_lsb2_q8(&axis.filter) / 256.0;
        }
        TEST_ASSERT_DOUBLE_WITHIN(0.3, 1.5, sum / 20 / (sigma_lsb * sigma_lsb));
    }
}

/* Two sigmas off what was held is a healthy sample, seven are none; quiet sensors have the floor's: sqrt(2) LSB. */
TEST(test_after_a_hold_the_laws_noise_decides_who_is_near)
{
    static const double sigmas_lsb[] = { 0.5, 1.4, 10.0, 40.0 };
    for (size_t i = 0; i < sizeof sigmas_lsb / sizeof sigmas_lsb[0]; i++) {
        double sigma_lsb = fmax(sigmas_lsb[i], 1.4142);
        for (int sign = -1; sign <= 1; sign += 2) {
            begin(DEFAULT_KIND, true);
            rest(sigmas_lsb[i]);
            hold();
            int16_t held_lsb = tilt_axis_estimate_lsb(&axis);
            tilt_axis_t held = axis;
            uint8_t flags = tilt_axis_update(&axis, (int16_t)(held_lsb + sign * lrint(7.0 * sigma_lsb)), RAIL_LSB,
                                             false);
            TEST_ASSERT_EQUAL_UINT8(TILT_GATED, flags);
            TEST_ASSERT_EQUAL_UINT8(2, axis.away);
            axis = held;
            (void)tilt_axis_update(&axis, (int16_t)(held_lsb + sign * lrint(2.0 * sigma_lsb)), RAIL_LSB, false);
            TEST_ASSERT_EQUAL_UINT8(0, axis.away);
        }
    }
}

/* sqrt(8) sigmas by R: at its floor at 100 Hz, 3 LSB^2, 4 LSB are near and 5 are none. */
TEST(test_near_is_up_to_the_root_of_eight_r)
{
    static const double sigmas_lsb[] = { 0.0, 8.0 };
    for (size_t i = 0; i < 2; i++) {
        begin(DEFAULT_KIND, false);
        rest(sigmas_lsb[i]);
        hold();
        tilt_axis_t held = axis;
        double most_lsb = sqrt(8.0 * filter_noise_r_lsb2_q8(&axis.noise) / 256.0);
        for (int off_lsb = -2 * (int)most_lsb; off_lsb <= 2 * (int)most_lsb; off_lsb++) {
            axis = held;
            (void)tilt_axis_update(&axis, (int16_t)(tilt_axis_estimate_lsb(&held) + off_lsb), RAIL_LSB, false);
            TEST_ASSERT_EQUAL_UINT8(fabs((double)off_lsb) <= most_lsb ? 0 : 2, axis.away);
        }
    }
}
