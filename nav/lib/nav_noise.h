/* Process noise, a state at a time, and what a gap owes. */
#ifndef NAV_NOISE_H
#define NAV_NOISE_H

#include "nav.h"

#ifdef __cplusplus
extern "C" {
#endif

/* walk: 1 sigma per period of position, velocity, attitude, drift. */
void nav_noise_start(nav_noise_t *noise, const nav_real_t walk[4], uint32_t period_us);

/* Time begins anew at t_us; what is owed stays so. */
void nav_noise_restart(nav_noise_t *noise, uint32_t t_us);

/* A gap of gap_s seconds more: what it may hold is owed by the jobs of position, velocity and attitude. */
void nav_noise_owe(nav_noise_t *noise, nav_real_t gap_s);

/*
 * One job: the noise of one state (of the three of the position at once, whose rows are short) since its last turn; one
 * that owes goes first. Nothing when no state has any.
 */
void nav_noise_job(nav_noise_t *noise, nav_real_t ud[NAV_PACKED], uint32_t t_us);

#ifdef __cplusplus
}
#endif
#endif
