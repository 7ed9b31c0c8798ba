/* The filter auto as its tests have it. */
#ifndef SUPPORT_AUTO_H
#define SUPPORT_AUTO_H

#include "filter.h"
#include "unity.h"

/* R = 16 LSB^2, sigma 4 LSB; 100 Hz: memories of 50, 20 and 8 samples; gates of 24 LSB, the slow one 48. */
#define SIGMA_LSB 4
#define R_LSB2_Q8 (SIGMA_LSB * SIGMA_LSB * 256)
#define GATE_LSB 24

static inline filter_t made_at_rest(int16_t z_lsb)
{
    filter_t f;
    filter_config_t config = filter_defaults(&filter_law_auto, 1000);
    config.value[AUTO_R_LSB2_Q8] = R_LSB2_Q8;
    TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(&f, &filter_law_auto, &config));
    filter_reset(&f, z_lsb);
    return f;
}

#endif
