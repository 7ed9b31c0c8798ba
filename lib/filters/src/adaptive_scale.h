/*
 * Formats and bounds that the two parts of adaptive share: adaptive_setup.c (parameters, start, what is told of it) and
 * adaptive.c (samples). Internal to the library.
 */
#ifndef ADAPTIVE_SCALE_H
#define ADAPTIVE_SCALE_H

#include "adaptive.h"
#include "fx.h"

#define X_MAX_LSB_Q16 ((int32_t)FILTER_X_MAX_LSB * 65536)

/* 127 LSB per sample: with the bound of x, all that 32 bits hold. */
#define RATE_LIMIT_LSB_Q24 ((int32_t)127 * 16777216)

/* k = 2 / 4096 */
#define K_MIN_UQ16 32U
/* The median of five samples is worth a memory of about four. */
#define K_START_UQ32 0x80000000U

#define SCATTER_MIN_LSB_UQ24 0x1A0000U   /* 0.1 LSB */
#define SCATTER_MAX_LSB_UQ24 0x5A000000U /* 90 LSB: its threshold lies below 128 LSB */

/*
 * E|d| of a third difference limited to 2.48 sigma is 0.7936 sqrt(20) = 3.549 sigma of a sample; the half of it is
 * kept. Its floor is that of a sigma of 0.1 LSB.
 */
#define SIGMA_OF_THIRD_UQ16 36932U /* 2 / 3.549 */
#define THIRD_OF_SIGMA_Q8 454U
#define THIRD_MIN_LSB_UQ24 0x2E0000U

/* The unguarded filter limits the innovations in their mean to four sigmas, as the guarded one to its gate. */
#define UNGUARDED_SIGMA_Q8 1024U

/*
 * Weights of a term: 1, 1/2, 1/4 twice, 1/8 four times..., the first four without a limit, because the R to start
 * from may be far off. The scatter's stays within 1/8..1/16.
 */
#define WEIGHT_START_UQ16 32768U
#define WEIGHT_LIMITED_UQ16 16384U
/* The first sixteen terms are doubted: the mean is too large when six on end lie below its half. */
#define WEIGHT_DOUBTED_UQ16 4096U
#define SMALL_TERMS 6U
#define WEIGHT_SCATTER_START_UQ16 8192U
#define WEIGHT_SCATTER_UQ16 4096U
#define WEIGHT_LAST_MAX_UQ16 1024U
#define WEIGHT_LAST_MIN_UQ16 64U

enum verdict { UNUSED, WITHIN_GATE, OUTLIER, MOTION, JUMP };

/* Rate of one sample in the format of x, rounded down towards `below`. */
FX_INLINE int32_t adaptive_rate_lsb_q16(const adaptive_t *f)
{
    int32_t rate = f->rate_lsb_q24 >> 8;
    return f->below ? -rate : rate;
}

#endif
