/*
 * Gains of synth_opt, UQ0.16, made by tools/design/schedule.py --emit library; do not edit. For each class of P0/R
 * (1, 4, 16, 64, 256, 1024) its first 4 steps; then the 8 further ones of all classes (those of 16), and the limit.
 * a1 of variant U; exact has 0.
 */
#ifndef SYNTH_OPT_TABLE_H
#define SYNTH_OPT_TABLE_H

#include "fx.h"

enum { SYNTH_OPT_CLASSES = 6, SYNTH_OPT_OWN_STEPS = 4, SYNTH_OPT_STEPS = 12 };

/* Index of step n >= SYNTH_OPT_OWN_STEPS: n + SYNTH_OPT_COMMON. */
enum { SYNTH_OPT_COMMON = 20 };

/* clang-format off */
static const uint16_t exact_b0_uq16[33] IN_FLASH = {
    32768, 32768, 39322, 41263, 52429, 52429, 50505, 47135, 61681, 61681, 53587, 48642,
    64528, 64528, 54357, 49024, 65281, 65281, 54549, 49120, 65472, 65472, 54597, 49144,
    46506, 45349, 44663, 44265, 44032, 43894, 43812, 43763, 43691,
};

static const uint16_t u_a1_uq16[33] IN_FLASH = {
    10923, 9466, 664, 15043, 10923, 2630, 21845, 0, 10923, 676, 21845, 0,
    10923, 170, 21845, 0, 10923, 43, 21845, 0, 10923, 11, 21845, 0,
    1140, 5632, 13916, 12120, 12373, 9831, 11141, 10334, 10923,
};

static const uint16_t u_b0_uq16[33] IN_FLASH = {
    56798, 55707, 53256, 56031, 63109, 58767, 58255, 53516, 64912, 62512, 59424, 53793,
    65379, 64595, 61503, 54118, 65497, 65286, 63795, 54409, 65526, 65472, 65003, 54552,
    53198, 53969, 55777, 55660, 55774, 55278, 55491, 55332, 55454,
};

#endif
