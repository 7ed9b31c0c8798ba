/* Position and velocity as computed in the past, for epochs that arrive late (paper 003, 3.3.5). */
#ifndef NAV_PAST_H
#define NAV_PAST_H

#include "nav.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Clears everything and starts with this state. */
void nav_past_restart(nav_past_t *past, const nav_state_t *state, uint32_t t_us);

/*
 * Stores the state at t_us if the last stored one is at least 19 ms old: ten of them reach back 150 ms and one step
 * more.
 */
void nav_past_keep(nav_past_t *past, const nav_state_t *state, uint32_t t_us);

/* Nothing stored since nav_init: no IMU record has been accepted. */
static inline bool nav_past_empty(const nav_past_t *past)
{
    return past->held == 0U;
}

/* A correction was made: x in the order of the error state. */
void nav_past_correct(nav_past_t *past, const nav_real_t x[NAV_STATES]);

/* t_us is not before the oldest stored entry. */
bool nav_past_reaches(const nav_past_t *past, uint32_t t_us);

/*
 * Velocity and position at epoch_us <= now_us, between two stored ones (or the last and the present state): linear, so
 * that a position errs by |acceleration| gap^2 / 8, 0.5 mm at 10 m/s^2 and 20 ms. Corrections made since the epoch are
 * included as they were made. That those of the velocity would also have moved the position since then, by correction x
 * time, is neglected.
 */
void nav_past_at(const nav_past_t *past, nav_real_t motion[6], uint32_t epoch_us, const nav_state_t *now,
                 uint32_t now_us);

#ifdef __cplusplus
}
#endif
#endif
