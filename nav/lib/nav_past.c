/* A ring buffer of the past: stored without the corrections, read with all of them. */
#include "nav_past.h"
#include "nav_time.h"
#include "nav_ud.h"

#define APART_US 19000

static void motion_of(nav_real_t motion[6], const nav_past_t *past, const nav_state_t *state)
{
    for (uint8_t i = 0; i < 3U; i++) {
        motion[i] = state->velocity_mps[i] - past->corrections[i];
        motion[3U + i] = state->position_m[i] - past->corrections[3U + i];
    }
}

static void put(nav_past_t *past, const nav_state_t *state, uint32_t t_us)
{
    past->t_us[past->newest] = t_us;
    motion_of(past->motion[past->newest], past, state);
}

void nav_past_restart(nav_past_t *past, const nav_state_t *state, uint32_t t_us)
{
    for (uint8_t i = 0; i < 6U; i++) {
        past->corrections[i] = 0;
    }
    past->newest = 0;
    past->held = 1;
    put(past, state, t_us);
}

void nav_past_keep(nav_past_t *past, const nav_state_t *state, uint32_t t_us)
{
    if (nav_time_from(past->t_us[past->newest], t_us) < APART_US) {
        return;
    }
    past->newest = (uint8_t)((past->newest + 1U < NAV_PAST) ? past->newest + 1U : 0U);
    if (past->held < NAV_PAST) {
        past->held++;
    }
    put(past, state, t_us);
}

void nav_past_correct(nav_past_t *past, const nav_real_t x[NAV_STATES])
{
    for (uint8_t i = 0; i < 3U; i++) {
        past->corrections[i] += x[NAV_V0 + i];
        past->corrections[3U + i] += x[NAV_R0 + i];
    }
}

/* Index of the entry `back` places before the newest. */
static uint8_t place(const nav_past_t *past, uint8_t back)
{
    return (uint8_t)((past->newest >= back) ? past->newest - back : past->newest + NAV_PAST - back);
}

bool nav_past_reaches(const nav_past_t *past, uint32_t t_us)
{
    return nav_time_from(past->t_us[place(past, (uint8_t)(past->held - 1U))], t_us) >= 0;
}

void nav_past_at(const nav_past_t *past, nav_real_t motion[6], uint32_t epoch_us, const nav_state_t *now,
                 uint32_t now_us)
{
    uint32_t behind_us = now_us;
    uint8_t at = past->newest;
    motion_of(motion, past, now);
    for (uint8_t back = 1; back < past->held && nav_time_from(past->t_us[at], epoch_us) < 0; back++) {
        behind_us = past->t_us[at];
        for (uint8_t i = 0; i < 6U; i++) {
            motion[i] = past->motion[at][i];
        }
        at = place(past, back);
    }
    nav_real_t share = 0;
    if (behind_us != past->t_us[at]) {
        share = nav_seconds(epoch_us, behind_us) / nav_seconds(past->t_us[at], behind_us);
    }
    for (uint8_t i = 0; i < 6U; i++) {
        motion[i] += share * (past->motion[at][i] - motion[i]);
        motion[i] += past->corrections[i];
    }
}
