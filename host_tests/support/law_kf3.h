/* What the rules of support/envelope.h need of kf3. PC only. */
#ifndef SUPPORT_LAW_KF3_H
#define SUPPORT_LAW_KF3_H

#include <stdint.h>

/* Gain of white noise, sum h^2, with the steady gains w1, w2 and w3 of x, v and a, per sample. */
double kf3_noise_gain_of(double w1, double w2, double w3);

/* Samples of one time constant at the default q. */
double kf3_time_constant_samples(uint16_t rate_dhz, double r_lsb2);

#endif
