/*
 * The yardstick of the benchmark: each filter of the list as one writes it with float from the textbook, and the
 * angles. Test only; never linked into the firmware. A filter's float_F.c has its state and all that is declared here
 * of it, and says in a line what `make bench` holds it to:
 *
 *   bench: worst 800 cycles; float / ours 4.0; rms 0.25 LSB
 *
 * The benchmark iterates over FILTER_LIST: a filter without its yardstick does not build.
 */
#ifndef FLOAT_FILTERS_H
#define FLOAT_FILTERS_H

#include <stdbool.h>
#include <stdint.h>

#include "filter_list.h"

/* Variance of the rate at the start, (200 LSB/s)^2: the same as in kalman.c. */
#define FLOAT_START_RATE_VARIANCE_LSB2_S2 40000.0f

/* start: runs from x0, as the filter after its warm-up; lengthen: parameters on a longer path than the defaults. */
#define FLOAT_FILTER(F)                                                                    \
    typedef struct float_##F float_##F##_t;                                                \
    extern float_##F##_t float_##F;                                                        \
    void float_##F##_start(float_##F##_t *f, const filter_config_t *config, float x0_lsb); \
    void float_##F##_set_noise(float_##F##_t *f, float r_lsb2);                            \
    float float_##F##_update(float_##F##_t *f, int16_t z_lsb);                             \
    float float_##F##_coast(float_##F##_t *f);                                             \
    void lengthen_##F(filter_config_t *config);
FILTER_LIST(FLOAT_FILTER)

/* A filter whose defaults already take the longest path. */
#define NOTHING_LONGER(F)                      \
    void lengthen_##F(filter_config_t *config) \
    {                                          \
        (void)config;                          \
    }

/* Degrees. */
void float_angles(float *roll, float *pitch, float x, float y, float z);

#endif
