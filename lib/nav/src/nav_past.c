/* A ring of the past: kept without the corrections, read with all of them. */
#include "nav_past.h"
#include "nav_time.h"
#include "nav_ud.h"

#define APART_US 19000

static nav_real_t motion_of(const nav_state_t *state, uint8_t i)
{
    return (i < 3U) ? state->position_m[i] : state->velocity_mps[i - 3U];
}

static void put(nav_past_t *past, const nav_state_t *state, uint32_t t_us)
{
    past->t_us[past->newest] = t_us;
    for (uint8_t i = 0; i < 6U; i++) {
        past->motion[past->newest][i] = motion_of(state, i) - past->corrections[i];
    }
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
    past->newest = (uint8_t)((past->newest + 1U) % NAV_PAST);
    if (past->held < NAV_PAST) {
        past->held++;
    }
    put(past, state, t_us);
}

void nav_past_correct(nav_past_t *past, const nav_real_t x[NAV_STATES])
{
    for (uint8_t i = 0; i < 3U; i++) {
        past->corrections[i] += x[NAV_R0 + i];
        past->corrections[3U + i] += x[NAV_V0 + i];
    }
}

/* The one kept `back` places before the newest. */
static uint8_t place(const nav_past_t *past, uint8_t back)
{
    return (uint8_t)((past->newest + NAV_PAST - back) % NAV_PAST);
}

bool nav_past_reaches(const nav_past_t *past, uint32_t t_us)
{
    return nav_time_from(past->t_us[place(past, (uint8_t)(past->held - 1U))], t_us) >= 0;
}

void nav_past_at(const nav_past_t *past, nav_real_t motion[6], uint32_t epoch_us, const nav_state_t *now,
                 uint32_t now_us)
{
    uint8_t back = 0;
    while (back + 1U < past->held && nav_time_from(past->t_us[place(past, back)], epoch_us) < 0) {
        back++;
    }
    uint8_t before = place(past, back);
    uint32_t behind_us = (back == 0U) ? now_us : past->t_us[place(past, (uint8_t)(back - 1U))];
    nav_real_t share = 0;
    if (behind_us != past->t_us[before]) {
        share = nav_seconds(past->t_us[before], epoch_us) / nav_seconds(past->t_us[before], behind_us);
    }
    for (uint8_t i = 0; i < 6U; i++) {
        nav_real_t begin = past->motion[before][i];
        nav_real_t end = (back == 0U) ? motion_of(now, i) - past->corrections[i]
                                      : past->motion[place(past, (uint8_t)(back - 1U))][i];
        motion[i] = begin + share * (end - begin) + past->corrections[i];
    }
}
