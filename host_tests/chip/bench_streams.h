/* Where the samples of bench.c come from; included there once. */
#ifndef BENCH_STREAMS_H
#define BENCH_STREAMS_H

#include <stdbool.h>
#include <stdint.h>

#include "bench_out.h"

static int16_t z_lsb;         /* the sample */
static volatile int32_t sink; /* the estimate after the last one */

static uint16_t sample_number;
static int16_t level_lsb;

/* A triangle of 128 LSB in 1000 samples, noise of 4.6 LSB rms, every seventh sample or so an outlier. */
static void typical(void)
{
    uint16_t phase = sample_number % 1000u;
    int16_t motion = (int16_t)((phase < 500u ? phase : 1000u - phase) >> 2);
    bool outlier = (uint8_t)uniform(8) < 37u;
    z_lsb = (int16_t)(motion + uniform(4) + (outlier ? uniform(8) : 0));
}

/* The level jumps every 12 samples: refused, then re-acquired; some jumps make a slope. */
static void steps(void)
{
    if (sample_number % 12u == 0) {
        level_lsb = uniform(13);
    }
    level_lsb = (int16_t)(level_lsb + ((sample_number & 16u) ? uniform(7) : 0));
    z_lsb = (int16_t)(level_lsb + uniform(3));
}

static void anything(void)
{
    z_lsb = uniform(16);
}

/* Long runs at one rail and the other, then a ramp as steep as it gets: every clamp. */
static void rails(void)
{
    z_lsb = ((sample_number / 9u) & 1u) ? INT16_MAX : INT16_MIN;
    if (sample_number & 64u) {
        z_lsb = (int16_t)((sample_number & 63u) * 128u - 4096u);
    }
}

/* Samples at chosen distances from the estimate, so that a grown covariance meets an accepted sample of either sign. */
static void near_the_estimate(void)
{
    uint8_t bits = (uint8_t)(1u + (uint8_t)(random_bits() >> 28));
    z_lsb = (int16_t)((int16_t)(sink >> 16) + (uniform(bits) >> 1));
}

typedef struct {
    const char *name;
    void (*sample)(void);
    uint16_t count;
    bool provoke; /* now and then runs of missing samples, and another R */
    bool longer;  /* with the parameters of bench_longer.h */
} regime_t;

static const char typical_name[] PROGMEM = "typical";
static const char steps_name[] PROGMEM = "steps";
static const char anything_name[] PROGMEM = "anything";
static const char rails_name[] PROGMEM = "rails";
static const char provoked_name[] PROGMEM = "provoked";
static const char longer_name[] PROGMEM = "longer";
static const regime_t regimes[] = {
    { typical_name, typical, 300, false, false },           { steps_name, steps, 150, false, false },
    { anything_name, anything, 100, false, false },         { rails_name, rails, 100, false, false },
    { provoked_name, near_the_estimate, 600, true, false }, { longer_name, near_the_estimate, 600, true, true },
};
static const uint16_t rates_dhz[] PROGMEM = { 125, 250, 500, 1000, 2000, 4000, 8000 };

#endif
