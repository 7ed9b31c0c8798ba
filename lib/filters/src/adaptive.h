/*
 * Inside `adaptive`: adaptive.c follows the samples, adaptive_noise.c identifies their noise, adaptive_setup.c derives
 * its constants. What the filter is stands in adaptive.c. Internal to the library.
 */
#ifndef ADAPTIVE_H
#define ADAPTIVE_H

#include "tracker.h"

#ifdef __cplusplus
extern "C" {
#endif

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

/* The noise of what was read before: R to start from (ignored once something was identified). */
void adaptive_set_noise(filter_t *f, uint32_t r_lsb2_q8);

/* One sample into the noise of a sample, where the turn is its third difference's, and into the history. */
FX_ONCE void adaptive_learn(filter_t *f, int16_t z_lsb);

/* The last innovation into the scatter, by how far it lies from their mean; spread is the sigma expected of it. */
FX_ONCE void adaptive_disperse(filter_adaptive_t *a, uint32_t size_lsb_uq16, uint16_t spread_uq8);

/* The measurement variance R in force, identified or given: LSB^2 in Q8. */
uint32_t adaptive_r_lsb2_q8(const filter_t *f);

/* A size of 8.8 bits, limited to 128 LSB. */
FX_INLINE uint16_t adaptive_size_lsb_uq8(uint32_t size_lsb_uq16)
{
    return (uint16_t)((size_lsb_uq16 >= 0x800000U) ? 0x7FFFU : size_lsb_uq16 >> 8);
}

/* The functions of its law. */
void adaptive_standard(filter_config_t *config);
void adaptive_set_up(filter_t *f, const filter_config_t *config);
void adaptive_start(filter_t *f, bool settled);
void adaptive_step(filter_t *f, int16_t z_lsb, uint8_t what);
void adaptive_report(const filter_t *f, filter_probe_t *out);

#ifdef __cplusplus
}
#endif
#endif
