/* The Kalman filter behind a binary gate of so many sigmas as paper 002 prints it, in float. */
#include <math.h>

#include "float_tracker.h"

/*
 * bench: worst 2250 cycles; float / ours 2.5; rms 0.25 LSB
 * its products are calls: it keeps to its cycles and saves flash before more
 */

struct float_sprf_paper {
    float_tracker_t tracker;
    float gate; /* sigmas */
};

float_sprf_paper_t float_sprf_paper;

NOTHING_LONGER(sprf_paper)

void float_sprf_paper_start(float_sprf_paper_t *f, const filter_config_t *config, float x0_lsb)
{
    float r = (float)config->value[SPRF_PAPER_R_LSB2_Q8] / 256.0f;
    f->gate = (float)config->value[SPRF_PAPER_GATE_SIGMA_Q8] / 256.0f;
    tracker_start(&f->tracker, config, (float)config->value[SPRF_PAPER_Q_LSB2_S3], r, x0_lsb);
}

void float_sprf_paper_set_noise(float_sprf_paper_t *f, float r_lsb2)
{
    f->tracker.r = r_lsb2;
}

float float_sprf_paper_coast(float_sprf_paper_t *f)
{
    tracker_predict(&f->tracker);
    return f->tracker.x;
}

float float_sprf_paper_update(float_sprf_paper_t *f, int16_t z_lsb)
{
    float_tracker_t *t = &f->tracker;
    tracker_predict(t);
    float s = t->p00 + t->r;
    float innovation = (float)z_lsb - t->x;
    if ((float)fabsf(innovation) <= f->gate * (float)sqrtf(s)) {
        tracker_correct(t, innovation, s);
    }
    return t->x;
}
