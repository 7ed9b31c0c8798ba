/*
 * What the two parts of auto share: auto_setup.c (parameters, start, what is told of it) and auto.c (samples). Internal
 * to the library.
 */
#ifndef AUTO_INSIDE_H
#define AUTO_INSIDE_H

#include "auto.h"
#include "filter_common.h"
#include "fx.h"

#define AUTO_X_MAX_LSB_Q16 ((int32_t)FILTER_X_MAX_LSB * 65536)

/* k = 0.6, a memory of 3.3 samples, also behind a restart; k = 2 / 512: beyond it a rate would round to a standstill */
#define AUTO_K_MAX_UQ16 FILTER_K_MAX_UQ16
#define AUTO_K_MIN_UQ16 256U
/* The median of five samples is worth a memory of about four. */
#define AUTO_K_START_UQ16 32768U

FX_INLINE bool auto_warming_up(const auto_t *f)
{
    return f->collected < FILTER_WARM_UP_SAMPLES;
}

/* All members at rest at a position, with the memory of the start or their own. */
FX_ONCE void auto_all_at(auto_t *f, int32_t x_lsb_q16, bool settled);

/* Estimate in force: the running median while warming up. */
FX_ONCE int32_t auto_estimate(const auto_t *f);

#endif
