/* Closed loop: the flights of paper 003 through lib/nav, against the printed figures and the table of the notes. */
#include "nav_flights.h"
#include "unity.h"

#include <math.h>
#include <stdio.h>

#define SEED 3000
#define DEGREE 57.29577951308232
enum { FLIGHTS = 20 };

void setUp(void) {}

void tearDown(void) {}

static nav_flight_t flight;

typedef struct {
    double heading_before, heading_without, level_without, position_without;
} flown_t;

static void fly_all(flown_t *median, nav_plan_t plan)
{
    double v[4][FLIGHTS];
    for (int i = 0; i < FLIGHTS; i++) {
        plan.seed = SEED + (uint32_t)i;
        nav_fly(&flight, &plan);
        v[0][i] = DEGREE * nav_worst_euler(&flight, 2, 40, 160);
        v[1][i] = DEGREE * nav_worst_euler(&flight, 2, 160, 399);
        v[2][i] = DEGREE * fmax(nav_worst_euler(&flight, 0, 160, 399), nav_worst_euler(&flight, 1, 160, 399));
        v[3][i] = nav_worst_position(&flight, 160, 399);
        TEST_ASSERT_TRUE(flight.least_d > 0.0);
    }
    *median = (flown_t){ nav_median(v[0], FLIGHTS), nav_median(v[1], FLIGHTS), nav_median(v[2], FLIGHTS),
                         nav_median(v[3], FLIGHTS) };
    printf(
        "%s drift %d q x%g field every %d%s: heading 40-160 %.2f, 160-400 %.2f deg; level %.2f deg; position %.0f m\n",
        plan.variant->name, plan.drift != &flight_no_drift, plan.walk_scale, plan.field_every,
        plan.at_once ? " at once" : "", median->heading_before, median->heading_without, median->level_without,
        median->position_without);
}

static void all(void)
{
    flown_t m;
    for (int once = 0; once < 2; once++) {
        fly_all(&m, (nav_plan_t){ &n9f, &flight_no_drift, 1.0, 100, once, 0, 0, 0, 500 });
        fly_all(&m, (nav_plan_t){ &n12f, &flight_gyro_drift, 1.0, 100, once, 0, 0, 0, 500 });
        fly_all(&m, (nav_plan_t){ &n12f, &flight_gyro_drift, 1.0, 10, once, 0, 0, 0, 500 });
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(all);
    return UNITY_END();
}
