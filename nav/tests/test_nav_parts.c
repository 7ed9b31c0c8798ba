/* Pieces of nav/lib: tau and the strapdown. */
#include "nav_flights.h"
#include "reference_nav.h"
#include "support/test.h"

#include <math.h>
#include <string.h>

static const double weight[3] = { 0, 0, -FLIGHT_GRAVITY };

static bool is_identity(const double *m, double tolerance)
{
    for (int i = 0; i < 9; i++) {
        if (fabs(m[i] - ((i % 4 == 0) ? 1.0 : 0.0)) > tolerance) {
            return false;
        }
    }
    return true;
}

static void square(double out[9], const double t[9])
{
    for (int i = 0; i < 9; i++) {
        out[i] = 0.0;
        for (int k = 0; k < 3; k++) {
            out[i] += t[3 * (i / 3) + k] * t[3 * (i % 3) + k];
        }
    }
}

/* The field of the paper's place, nT; its numbers from the notes. */
TEST(tau_is_orthogonal_and_turns_the_field_to_the_first_axis)
{
    const double nanotesla[3] = { 17818.0, 1951.0, 41847.0 };
    const double want[9] = { .391395644,  .042856263,  .919224015,  -.042856263, .998679988,
                             -.028312944, -.919224015, -.028312944, .392715656 };
    double length = sqrt(17818.0 * 17818.0 + 1951.0 * 1951.0 + 41847.0 * 41847.0);
    const double u[3] = { nanotesla[0] / length, nanotesla[1] / length, nanotesla[2] / length };
    double tau[9];
    double product[9];
    reference_nav_tau(tau, u, false);
    for (int i = 0; i < 9; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, want[i], tau[i]);
    }
    square(product, tau);
    TEST_ASSERT_TRUE(is_identity(product, 1e-15));
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-15, i == 0, tau[3 * i] * u[0] + tau[3 * i + 1] * u[1] + tau[3 * i + 2] * u[2]);
    }
    TEST_ASSERT_DOUBLE_WITHIN(5e-4, 66.813,
                              asin(u[2]) * 57.29577951308232); /* inclination and declination as printed */
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 6.248, atan2(u[1], u[0]) * 57.29577951308232);
    for (int v = 0; v < NAV_ALL; v++) {
        double rows[6];
        TEST_ASSERT_TRUE(nav_all[v]->tau(rows, nanotesla));
        for (int i = 0; i < 6; i++) {
            TEST_ASSERT_DOUBLE_WITHIN(nav_all[v]->in_double ? 1e-9 : 1e-7, want[3 + i], rows[i]);
        }
    }
}

TEST(tau_of_directions_that_have_none_is_refused)
{
    const double none[4][3] = { { 0, 0, 0 }, { -1, 0, 0 }, { NAN, 0, 1 }, { 1e20, 0, 0 } };
    double rows[6];
    for (int v = 0; v < NAV_ALL; v++) {
        for (int i = 0; i < 4; i++) {
            TEST_ASSERT_FALSE(nav_all[v]->tau(rows, none[i]));
        }
    }
}

/* (3.34) with another length: tau tau' = p^2 I needs p + mag1 in the denominator. */
TEST(printed_tau_is_orthogonal_for_unit_length_only)
{
    const double mag[3] = { 0.7828, 0.0858, 1.8384 };
    double tau[9];
    double product[9];
    double squared = mag[0] * mag[0] + mag[1] * mag[1] + mag[2] * mag[2];
    for (int printed = 0; printed < 2; printed++) {
        reference_nav_tau(tau, mag, printed != 0);
        square(product, tau);
        for (int i = 0; i < 9; i++) {
            product[i] /= squared;
        }
        TEST_ASSERT_EQUAL(printed == 0, is_identity(product, 1e-14));
    }
}

/* A turn at a constant rate: the rotation of a step against sine and cosine, and its error as the header has it. */
TEST(step_turns_by_the_rotation_vector)
{
    for (double angle = 0.01; angle < 0.5; angle *= 1.3) {
        nav_values_t s = { { 1, 0, 0, 0 }, { 0 }, { 0 }, { 0 } };
        double force[3];
        const double rate[3] = { 0, 0, 100.0 * angle };
        n12d.step(&s, force, rate, weight, FLIGHT_GRAVITY, 0.01);
        double turned = 2.0 * atan2(s.quaternion[3], s.quaternion[0]);
        TEST_ASSERT_DOUBLE_WITHIN(1.1 * pow(angle, 5.0) / 480.0 + 1e-15, 0.0, turned - angle);
        TEST_ASSERT_TRUE(fabs(turned - angle) > 0.8 * pow(angle, 5.0) / 480.0 - 1e-15);
    }
}

/* Without noise and drift the flight is followed for 500 s to what linear motion within 10 ms leaves out. */
TEST(exact_records_are_followed)
{
    flight_truth_t truth;
    nav_values_t s;
    flight_truth(&truth, 0.0);
    memset(&s, 0, sizeof s);
    memcpy(s.quaternion, truth.quaternion, sizeof s.quaternion);
    memcpy(s.velocity, truth.velocity, sizeof s.velocity);
    memcpy(s.position, truth.position, sizeof s.position);
    for (int k = 0; k < 50000; k++) {
        double c[9];
        double force[3] = { 0 };
        double ned[3];
        flight_truth(&truth, (k + 0.5) * FLIGHT_STEP);
        flight_dcm(c, truth.quaternion);
        for (int i = 0; i < 9; i++) {
            force[i % 3] += c[i] * (truth.acceleration[i / 3] + weight[i / 3]);
        }
        n12d.step(&s, ned, truth.rate, force, FLIGHT_GRAVITY, FLIGHT_STEP);
    }
    flight_truth(&truth, 500.0);
    double angles[3];
    double want[3];
    flight_euler(angles, s.quaternion);
    flight_euler(want, truth.quaternion);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, 0.0, remainder(angles[i] - want[i], 6.283185307179586));
        TEST_ASSERT_DOUBLE_WITHIN(1e-2, truth.velocity[i], s.velocity[i]);
        TEST_ASSERT_DOUBLE_WITHIN(2.0, truth.position[i], s.position[i]);
    }
}

/* From rest with 10 m/s^2 upwards for 0.1 s: 1 m/s and 0.05 m. */
TEST(step_goes_with_the_mean_velocity)
{
    nav_values_t s = { { 1, 0, 0, 0 }, { 0 }, { 0 }, { 0 } };
    double ned[3];
    const double still[3] = { 0, 0, 0 };
    const double force[3] = { 0, 0, -FLIGHT_GRAVITY - 10.0 };
    n12d.step(&s, ned, still, force, FLIGHT_GRAVITY, 0.1);
    TEST_ASSERT_DOUBLE_WITHIN(1e-14, -1.0, s.velocity[2]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, -0.05, s.position[2]);
}

static bool near(double want, double is, bool in_double)
{
    return fabs(is - want) <= (in_double ? 1e-12 : 1e-5) * fabs(want);
}

/* Behind a round of all jobs at one time each variance has grown by its walk's square per period, by nothing else. */
TEST(noise_adds_each_walk_to_its_own_states)
{
    for (int v = 0; v < NAV_ALL; v++) {
        const nav_variant_t *n = nav_all[v];
        for (int walks = 0; walks < 16; walks++) { /* a bit per walk that is not 0 */
            static const double one[4] = { 1, 1, 1, 1 };
            nav_memory_t m;
            double walk[4];
            double p[144];
            for (int i = 0; i < 4; i++) {
                walk[i] = (walks >> i & 1) ? 0.1 * (i + 1) : 0.0;
            }
            memset(&m, 0, sizeof m);
            n->ud_start(&m, one);
            n->noise_start(&m, walk, 10000);
            for (uint32_t job = 0; job < 100U; job++) {
                n->noise_job(&m, (job < 80U) ? 10000U * job : 1000000U);
            }
            n->covariance(&m, p);
            for (int i = 0; i < n->states * n->states; i++) {
                int state = i / n->states;
                double want = 1.0 + 100.0 * walk[state / 3] * walk[state / 3];
                TEST_ASSERT_TRUE((i % n->states == state) ? near(want, p[i], n->in_double) : p[i] == 0.0);
            }
        }
    }
}

/* From nothing known to vary: P = c a a', the definition, and what has variance 0 keeps it. */
TEST(spread_from_zero_is_the_outer_product)
{
    static const double none[4] = { 0, 0, 0, 0 };
    for (int v = 0; v < NAV_ALL; v++) {
        const nav_variant_t *n = nav_all[v];
        for (int k = 0; k < n->states; k++) {
            const double along[12] = { 0.5, -2, 3, 0.25, 1.5, -1, 2, -0.75, 1, 4, -3, 1.25 };
            nav_memory_t m;
            double p[144];
            memset(&m, 0, sizeof m);
            n->ud_start(&m, none);
            n->ud_spread(&m, along, k, 0.0);
            n->ud_spread(&m, along, k, 2.0);
            n->covariance(&m, p);
            for (int i = 0; i < n->states * n->states; i++) {
                int row = i / n->states;
                int other = i % n->states;
                double want = (row <= k && other <= k) ? 2.0 * along[row] * along[other] : 0.0;
                TEST_ASSERT_TRUE(near(want, p[i], n->in_double));
            }
        }
    }
}
