/* Two states of the channel, in float: what a few yardsticks share. */
#ifndef FLOAT_MIXTURE_H
#define FLOAT_MIXTURE_H

#include "float_tracker.h"

typedef struct {
    float_tracker_t tracker;
    float ratio2; /* N^2 */
    float clean;  /* probability of a normal sample */
    float count;  /* samples that it is learnt from; 0: given */
} float_mixture_t;

void float_mixture_start(float_mixture_t *f, const filter_config_t *config, float x0_lsb);
float float_mixture_coast(float_mixture_t *f);

/* Prediction; the probability that the sample is normal, and the gains of the two cases. */
float float_mixture_weigh(float_mixture_t *f, int16_t z_lsb, float *innovation, float *normal, float *outlier);

/* x by m, P by m2, both per LSB^2. */
void float_mixture_apply(float_mixture_t *f, float innovation, float m, float m2);

/* The numbers whose normalising takes longest. */
void float_mixture_lengthen(filter_config_t *config);

#endif
