/* Process noise, one state at a time, and the uncertainty owed for a gap. */
#ifndef NAV_NOISE_H
#define NAV_NOISE_H

#include "nav.h"

#ifdef __cplusplus
extern "C" {
#endif

/* walk: 1 sigma per period of position, velocity, attitude, drift. */
void nav_noise_start(nav_noise_t *noise, const nav_real_t walk[4], uint32_t period_us);

/* Time restarts at t_us; what is owed is kept. */
void nav_noise_restart(nav_noise_t *noise, uint32_t t_us);

/* Adds a gap of gap_s seconds: the jobs of position, velocity and attitude owe its uncertainty. */
void nav_noise_owe(nav_noise_t *noise, nav_real_t gap_s);

/*
 * One job: the noise of one state since its last turn (for the position all three states at once, whose rows are
 * short). A job that owes goes first. Does nothing if no state has any.
 */
void nav_noise_job(nav_noise_t *noise, nav_real_t ud[NAV_PACKED], uint32_t t_us);

#ifdef __cplusplus
}
#endif
#endif
