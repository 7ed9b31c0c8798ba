/*
 * lib/tilt against double: the square root and the arc tangent over whole grids, roll and pitch on a 0.1-degree sphere.
 *
 * Where the error bounds come from (degrees, all worst cases added):
 *   legs cut to 15 bits   2^-14 rad          0.0035     polynomial (minimax fit)             0.0047
 *   ratio in UQ0.16       2^-16 rad          0.0009     its coefficients, 1/2 unit each      0.0025
 *   products rounded down 3 units of 1/800   0.0038     last digit of the angle              0.0050   sum 0.0204
 * and for pitch the length of (y, z): polynomial 8.3e-5, products 3 / 2^15, legs 2^-14, Q8 unit 2^-14 at 0.25 g,
 * together 3.0e-4, times 1/2 rad at the worst elevation: 0.0085 more.
 */
#include <math.h>
#include <stdio.h>

#include "support/test.h"
#include "tilt.h"

#define ATAN2_BOUND_DEG 0.0204
#define PITCH_BOUND_DEG 0.0289
#define GOAL_DEG 0.06
#define SPHERE_STEPS 3600

static const double DEG_PER_RAD = 57.295779513082320877;

static double worst_roll_deg;
static double worst_pitch_deg;

void setUp(void)
{
    worst_roll_deg = 0.0;
    worst_pitch_deg = 0.0;
}

/* xorshift32, seed fixed */
static uint32_t next_random(uint32_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return *state;
}

static double wrapped_error_deg(int16_t angle_cdeg, double truth_rad)
{
    double error = (double)angle_cdeg / 100.0 - truth_rad * DEG_PER_RAD;
    if (error > 180.0) {
        error -= 360.0;
    }
    if (error < -180.0) {
        error += 360.0;
    }
    return fabs(error);
}

static void check_root(uint32_t v)
{
    uint64_t root = tilt_isqrt32(v);
    if (root * root > v || (root + 1U) * (root + 1U) <= v) {
        char message[64];
        (void)snprintf(message, sizeof message, "isqrt32(%lu) = %lu", (unsigned long)v, (unsigned long)root);
        TEST_FAIL_MESSAGE(message);
    }
}

TEST(test_isqrt_is_exact_on_a_stride_through_all_words)
{
    for (uint32_t i = 0; i < (1UL << 24); i++) {
        check_root(i * 256U + (i & 0xFFU));
    }
    check_root(UINT32_MAX);
}

/* Worst |error| of one ratio in all eight octants. */
static double worst_of_octants(int32_t a, int32_t b)
{
    double worst = 0.0;
    for (int octant = 0; octant < 8; octant++) {
        int32_t y = ((octant & 1) != 0) ? -a : a;
        int32_t x = ((octant & 2) != 0) ? -b : b;
        int32_t up = ((octant & 4) != 0) ? x : y;
        int32_t right = ((octant & 4) != 0) ? y : x;
        int16_t angle = tilt_atan2_cdeg(up, right);
        double error = wrapped_error_deg(angle, atan2((double)up, (double)right));
        worst = fmax(worst, error);
        if (angle <= -18000 || angle > 18000) {
            TEST_FAIL_MESSAGE("angle outside -17999..18000");
        }
    }
    return worst;
}

TEST(test_atan2_over_every_16_bit_ratio_in_all_octants)
{
    double worst = 0.0;
    for (int32_t n = 0; n <= 65536; n++) {
        worst = fmax(worst, worst_of_octants(n, 65536));
    }
    printf("atan2, ratios n/65536: worst error %.4f degree\n", worst);
    TEST_ASSERT_TRUE(worst <= ATAN2_BOUND_DEG);
}

TEST(test_atan2_at_every_magnitude)
{
    uint32_t random = 20250101U;
    double worst = 0.0;
    for (uint32_t i = 0; i < 500000U; i++) {
        uint32_t y = (next_random(&random) & 0x3FFFFFFFU) >> (next_random(&random) % 31U);
        uint32_t x = (next_random(&random) & 0x3FFFFFFFU) >> (next_random(&random) % 31U);
        worst = fmax(worst, worst_of_octants((int32_t)y, (int32_t)x));
        uint32_t mask = 0x3FFFFFFFU >> (i % 30U);
        worst = fmax(worst, worst_of_octants((int32_t)(y & mask), (int32_t)(x & mask)));
    }
    printf("atan2, all magnitudes (seed 20250101): worst error %.4f degree\n", worst);
    TEST_ASSERT_TRUE(worst <= ATAN2_BOUND_DEG);
}

static void check_point(int32_t x, int32_t y, int32_t z)
{
    tilt_t tilt = { .roll_cdeg = 12345 };
    tilt_angles(&tilt, (const int32_t[]){ x, y, z });
    double yz = sqrt((double)y * y + (double)z * z);
    double pitch_error = wrapped_error_deg(tilt.pitch_cdeg, atan2(-(double)x, yz));
    worst_pitch_deg = fmax(worst_pitch_deg, pitch_error);
    if (tilt.roll_undefined) {
        TEST_ASSERT_EQUAL_INT16(12345, tilt.roll_cdeg);
        TEST_ASSERT_TRUE(yz < TILT_ROLL_MIN_Q8 + 1.0);
        return;
    }
    TEST_ASSERT_TRUE(yz > TILT_ROLL_MIN_Q8 - 1.0);
    worst_roll_deg = fmax(worst_roll_deg, wrapped_error_deg(tilt.roll_cdeg, atan2((double)y, (double)z)));
}

static void check_sphere(double radius_lsb)
{
    static double sine[SPHERE_STEPS];
    for (int i = 0; i < SPHERE_STEPS; i++) {
        sine[i] = sin((double)i * 0.1 / DEG_PER_RAD);
    }
    double radius_q8 = radius_lsb * 256.0;
    for (int pitch = -900; pitch <= 900; pitch++) {
        double across = sine[(pitch + 4500) % SPHERE_STEPS];
        int32_t x = (int32_t)lround(-radius_q8 * sine[(pitch + 3600) % SPHERE_STEPS]);
        for (int roll = 0; roll < SPHERE_STEPS; roll++) {
            double y = radius_q8 * across * sine[roll];
            double z = radius_q8 * across * sine[(roll + 900) % SPHERE_STEPS];
            check_point(x, (int32_t)floor(y + 0.5), (int32_t)floor(z + 0.5));
        }
    }
    printf("sphere of %.2f g: worst roll %.4f, pitch %.4f degree\n", radius_lsb / 256.0, worst_roll_deg,
           worst_pitch_deg);
    TEST_ASSERT_TRUE(worst_roll_deg <= ATAN2_BOUND_DEG && ATAN2_BOUND_DEG <= GOAL_DEG);
    TEST_ASSERT_TRUE(worst_pitch_deg <= PITCH_BOUND_DEG && PITCH_BOUND_DEG <= GOAL_DEG);
}

TEST(test_angles_on_the_smallest_sphere)
{
    check_sphere(64.0);
}

TEST(test_angles_on_the_sphere_of_one_g)
{
    check_sphere(256.0);
}

TEST(test_angles_in_the_whole_box_of_states)
{
    const int32_t limit_q8 = 4608 * 256;
    uint32_t random = 20250102U;
    for (uint32_t i = 0; i < 2000000U; i++) {
        int32_t a[3];
        for (int axis = 0; axis < 3; axis++) {
            int32_t range = limit_q8 >> (next_random(&random) % 20U);
            a[axis] = (int32_t)(next_random(&random) % (uint32_t)(2 * range + 1)) - range;
        }
        if ((double)a[0] * a[0] + (double)a[1] * a[1] + (double)a[2] * a[2] >= 16384.0 * 16384.0) {
            check_point(a[0], a[1], a[2]);
        }
    }
    for (int corner = 0; corner < 8; corner++) {
        check_point((corner & 1) ? limit_q8 : -limit_q8, (corner & 2) ? limit_q8 : -limit_q8,
                    (corner & 4) ? limit_q8 : -limit_q8);
    }
    printf("box (seed 20250102): worst roll %.4f, pitch %.4f degree\n", worst_roll_deg, worst_pitch_deg);
    TEST_ASSERT_TRUE(worst_roll_deg <= ATAN2_BOUND_DEG);
    TEST_ASSERT_TRUE(worst_pitch_deg <= PITCH_BOUND_DEG);
}

TEST(test_gravity_verdict_equals_the_double_one_away_from_the_limits)
{
    uint32_t random = 20250104U;
    uint32_t judged = 0;
    for (uint32_t i = 0; i < 500000U; i++) {
        int32_t a[3];
        for (int axis = 0; axis < 3; axis++) {
            a[axis] = (int32_t)(next_random(&random) % 120001U) - 60000;
        }
        double g = sqrt((double)a[0] * a[0] + (double)a[1] * a[1] + (double)a[2] * a[2]) / 65536.0;
        if (fabs(g - 0.85) > 2e-4 && fabs(g - 1.15) > 2e-4) {
            TEST_ASSERT_EQUAL(g > 0.85 && g < 1.15, tilt_gravity_plausible(a));
            judged++;
        }
    }
    TEST_ASSERT_TRUE(judged > 490000U);
}
