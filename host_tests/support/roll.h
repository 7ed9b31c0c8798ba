/*
 * Paper 000's roll as a sensor gives it: 15 s at 10 Hz, in motion from 6 to 10 s, noise of variance R = 0.6 degree^2,
 * 16 LSB per degree. Squared errors over its windows.
 */
#ifndef SUPPORT_ROLL_H
#define SUPPORT_ROLL_H

#include <stdint.h>

enum { ROLL_SAMPLES = 151, ROLL_LSB_PER_DEGREE = 16 };
#define ROLL_R_DEG2 0.6
#define ROLL_OUTLIER_RATIO 20.0

typedef enum { RAMP30, COS60, BUMP30, SINE30, STILL, PROFILES } roll_profile_t;
typedef struct {
    double rest, turn, after; /* 2-5, 6-10, 11-15 s, deg^2 */
} roll_windows_t;

extern const char *const roll_profile_names[PROFILES];

double roll_truth_deg(roll_profile_t profile, double t_s);

/* Uniform in 0..1, both excluded; random32's state. */
double roll_uniform(uint32_t *random);

/* share: of samples whose noise is 20 times the usual. */
int16_t roll_measured_lsb(uint32_t *random, double degrees, double share);

/* Adds what the error of sample k is to its window's mean square. */
void roll_count(roll_windows_t *mean, int k, double error_deg);

/* Of a sum over so many runs. */
roll_windows_t roll_mean(const roll_windows_t *sum, int runs);

#endif
