/* Any state of adaptive within its bounds, for the entries of its proof. */
#ifndef ADAPTIVE_STATES_H
#define ADAPTIVE_STATES_H

#include "adaptive_bounds.h"
#include "filter_common.h"

static void any_told(adaptive_t *f)
{
    f->rate_max_lsb_q24 = ANY_S32(0, RATE_END);
    f->gate_sigma_q8 = ANY_U16(256, 4096);
    f->manoeuvre_uq16 = ANY_U16(0, UINT16_MAX);
    f->slow_uq16 = ANY_U16(32, 39322);
    f->fast_uq16 = ANY_U16(32, 39322);
    f->share_uq16 = ANY_U16(0, 15728);
    f->confirm = ANY_U16(3, UINT16_MAX);
    f->jump_lsb_uq8 = ANY_U16(0, UINT16_MAX);
    f->guarded = ANY_BOOL();
    f->identify = ANY_BOOL();
    f->by_turns = ANY_U8(0, 1);
}

static void any_state(adaptive_t *f)
{
    any_told(f);
    f->x_lsb_q16 = ANY_S32(-X_MAX_Q16, X_MAX_Q16);
    f->rate_lsb_q24 = ANY_S32(-RATE_END, RATE_END);
    f->mean_lsb_q24 = ANY_S32(-MEAN_END, MEAN_END);
    f->k_uq32 = ANY_U32(0, K_END);
    f->scatter_lsb_uq24 = ANY_U32(SCATTER_LEAST, SCATTER_END);
    f->third_lsb_uq24 = ANY_U32(THIRD_LEAST, THIRD_END);
    for (uint8_t i = 0; i < 3U; i++) {
        f->history_lsb[i] = ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB);
    }
    f->filled = ANY_U8(0, 3);
    f->third = ANY_U8(0, 1);
    f->verdict = ANY_U8(0, 4);
    f->below = ANY_BOOL();
    f->run = ANY_U16(0, UINT16_MAX);
    f->flags = ANY_U8(0, 31);
    f->small = ANY_U8(0, 5);
    f->largest_lsb_uq8 = ANY_U16(0, 40704);
}

/* A weight, a power of 2, with the number of terms that it is for. */
static void any_weight(adaptive_t *f, uint16_t weight_uq16, uint16_t last_uq16)
{
    f->weight_uq16 = weight_uq16;
    f->stage = (uint16_t)(32768U / weight_uq16);
    f->terms = ANY_U16(1, 2U * f->stage);
    f->last_uq16 = last_uq16;
}

static void any_run(adaptive_t *f)
{
    any_state(f);
    f->collected = FILTER_WARM_UP_SAMPLES;
    f->u.run.size_lsb_uq16 = ANY_U32(0, SIZE_END);
    f->u.run.gate_lsb_uq16 = ANY_U32(0, GATE_END);
    f->u.run.before_lsb_q16 = ANY_S32(-SIZE_END, SIZE_END);
}

static void any_start(adaptive_t *f, uint8_t from_collected, uint8_t to_collected)
{
    any_state(f);
    f->collected = ANY_U8(from_collected, to_collected);
    f->flags = ANY_BOOL() ? FILTER_WARMING_UP : FILTER_WARMING_UP | FILTER_COASTED;
    for (uint8_t i = 0; i < FILTER_WARM_UP_SAMPLES; i++) {
        f->u.start_lsb[i] = ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB);
    }
}

#define EACH_LAST(last) for (uint16_t last = 64; last <= 1024U; last = (uint16_t)(last * 2U))
#define EACH_WEIGHT(weight, last) for (uint16_t weight = 32768U; weight >= (last); weight = (uint16_t)(weight / 2U))
#endif
