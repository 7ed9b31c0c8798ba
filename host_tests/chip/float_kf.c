/* Two-state Kalman filter with a full 2x2 covariance, in float. */
#include "float_tracker.h"

/* bench: worst 1080 cycles; float / ours 4.0; rms 0.25 LSB */

struct float_kf {
    float_tracker_t tracker;
};

float_kf_t float_kf;

NOTHING_LONGER(kf)

void float_kf_start(float_kf_t *f, const filter_config_t *config, float x0_lsb)
{
    float r = (float)config->value[KF_R_LSB2_Q8] / 256.0f;
    tracker_start(&f->tracker, config, (float)config->value[KF_Q_LSB2_S3], r, x0_lsb);
}

void float_kf_set_noise(float_kf_t *f, float r_lsb2)
{
    f->tracker.r = r_lsb2;
}

float float_kf_coast(float_kf_t *f)
{
    tracker_predict(&f->tracker);
    return f->tracker.x;
}

float float_kf_update(float_kf_t *f, int16_t z_lsb)
{
    float_tracker_t *t = &f->tracker;
    tracker_predict(t);
    tracker_correct(t, (float)z_lsb - t->x, t->p00 + t->r);
    return t->x;
}
