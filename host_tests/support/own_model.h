/* A law on the model that it is made for: white acceleration of its q, white noise of its R, at an output data rate. */
#ifndef SUPPORT_OWN_MODEL_H
#define SUPPORT_OWN_MODEL_H

#include "filter.h"

typedef struct {
    double nis;   /* mean of u^2 / S over the samples that were used */
    double gated; /* share of the samples that were not */
    double rmse;  /* of the estimate over that of the double reference, which knows no gate */
} own_model_t;

/*
 * The law's first parameters are r and q, which config has. R counts the sensor's rounding, 1/12 LSB^2. Runs of 8 s,
 * or 80 samples, in which the motion stays within the range: 30,000 samples.
 */
own_model_t own_model(const filter_law_t *law, const filter_config_t *config, uint64_t seed);

#endif
