/*
 * What the tests of single laws do inside a filter, on the PC and on the chip: begin where a paper begins, and miss
 * samples without the tracker's damping and hold.
 */
#ifndef SUPPORT_LAWS_H
#define SUPPORT_LAWS_H

#include "kalman.h"
#include "support/filters.h"
#include "wide.h"

/* A sample missing: the prediction alone, whether the filter runs or collects. */
static inline int32_t coast(filter_t *f)
{
    return (f->collected == FILTER_RUNNING) ? coast_only(f) : filter_missing(f);
}

static inline uint32_t at_most(uint32_t v, uint32_t limit)
{
    return (v < limit) ? v : limit;
}

/* The plain Kalman filter with the R and q of another law's configuration; false: refused. */
static inline bool init_plain(filter_t *f, const filter_config_t *config)
{
    filter_config_t plain = { config->rate_dhz,
                              { [KF_R_LSB2_Q8] = config->value[KALMAN_R], [KF_Q_LSB2_S3] = config->value[KALMAN_Q] } };
    return filter_init(f, &filter_law_kf, &plain) == FILTER_ACCEPTED;
}

/* Running from a position and a rate within their bounds. */
static inline void run_from(filter_t *f, int32_t x_lsb_q16, int32_t rate_lsb_q16)
{
    filter_restart(f);
    f->x_lsb_q16 = fx_clamp(x_lsb_q16, TRACKER_X_MAX_LSB_Q16);
    f->collected = FILTER_RUNNING;
    LAW_OF(f, start)(f, false);
    f->rate_lsb = fx_clamp(rate_lsb_q16, (int32_t)f->rate_max_lsb);
    f->flags = 0;
}

/* A Kalman law running from a state and a covariance per R (UQ8.24, UQ6.26 twice), within its range of kalman.h. */
static inline void kalman_from(filter_t *f, int32_t x_lsb_q16, int32_t rate_lsb_q16, filter_covariance_t p)
{
    run_from(f, x_lsb_q16, rate_lsb_q16);
    p.p11 = at_most(p.p11, 0x33FFFFFFUL);
    p.p12 = at_most(p.p12, at_most(p.p11, 0x1FFFFFFFUL) * 4U);
    p.p22 = at_most(p.p22, 0x77FFFFFFUL);
    f->own.kalman.p = p;
}

/* A law of paper 002 likewise: P11, P12, P22 per R in UQ16.16, UQ8.24, UQ4.28, each within its range of wide.h. */
static inline void wide_from(filter_t *f, int32_t x_lsb_q16, int32_t rate_lsb_q16, filter_covariance_t p)
{
    run_from(f, x_lsb_q16, rate_lsb_q16);
    p.p11 = at_most(p.p11, WIDE_P_END);
    p.p12 = at_most(p.p12, WIDE_P_END);
    p.p22 = at_most(p.p22, WIDE_P_END);
    f->own.wide.p = p;
}

#endif
