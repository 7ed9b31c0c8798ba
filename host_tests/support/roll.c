#include "support/roll.h"
#include "support/filters.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

const char *const roll_profile_names[PROFILES] = { "ramp30", "cos60", "bump30", "sine30", "still" };

double roll_truth_deg(roll_profile_t profile, double t_s)
{
    double s = fmin(1.0, fmax(0.0, (t_s - 6.0) / 4.0));
    switch (profile) {
    case RAMP30:
        return 30.0 * s;
    case COS60:
        return 30.0 - 30.0 * cos(pi * s);
    case BUMP30:
        return 15.0 - 15.0 * cos(2.0 * pi * s);
    case SINE30:
        return 30.0 * sin(2.0 * pi * s);
    case STILL:
    case PROFILES:
        break;
    }
    return 0.0;
}

double roll_uniform(uint32_t *random)
{
    return ((double)random32(random) + 0.5) / 4294967296.0;
}

static double normal(uint32_t *random)
{
    double radius = sqrt(-2.0 * log(roll_uniform(random)));
    return radius * cos(2.0 * pi * roll_uniform(random));
}

int16_t roll_measured_lsb(uint32_t *random, double degrees, double share)
{
    double sigma = sqrt(ROLL_R_DEG2) * (roll_uniform(random) < share ? ROLL_OUTLIER_RATIO : 1.0);
    double lsb = (degrees + sigma * normal(random)) * ROLL_LSB_PER_DEGREE;
    return (int16_t)lrint(fmin(4095.0, fmax(-4096.0, lsb)));
}

void roll_count(roll_windows_t *mean, int k, double error_deg)
{
    double square = error_deg * error_deg;
    mean->rest += (k >= 20 && k <= 50) ? square / 31.0 : 0.0;
    mean->turn += (k >= 60 && k <= 100) ? square / 41.0 : 0.0;
    mean->after += (k >= 110) ? square / 41.0 : 0.0;
}

roll_windows_t roll_mean(const roll_windows_t *sum, int runs)
{
    return (roll_windows_t){ sum->rest / runs, sum->turn / runs, sum->after / runs };
}
