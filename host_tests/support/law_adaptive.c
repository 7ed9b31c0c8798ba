/* adaptive: its bounds, and what no descriptor tells (support/law_facts.h). */
#include "adaptive.h"
#include "support/law_facts.h"

static const char *broken_adaptive_memory(const filter_t *f)
{
    const filter_adaptive_t *a = &f->own.adaptive;
    if (a->slow_uq16 < ADAPTIVE_K_MIN_UQ16 || a->fast_uq16 < a->slow_uq16 || a->fast_uq16 > TRACKER_K_MAX_UQ16) {
        return "memory";
    }
    if (running(f) && a->k_uq32 >> 16 > TRACKER_K_MAX_UQ16) {
        return "memory in force";
    }
    return (a->confirm < ADAPTIVE_CONFIRM_LEAST || a->learnt > ADAPTIVE_OPENING_TERMS) ? "counts" : NULL;
}

/*
 * adaptive.c: the sigma is that of the R that was set (at most 31.7 LSB) or between 0.1 and 90 LSB, memory between 3.3
 * and 4096 samples, a gate of 16 times 256 LSB; mean and gate lie where the samples of the start were.
 */
const char *broken_adaptive(const filter_t *f)
{
    const filter_adaptive_t *a = &f->own.adaptive;
    if (a->scatter_lsb_uq24 < ADAPTIVE_SCATTER_MIN_UQ24 || a->scatter_lsb_uq24 > ADAPTIVE_SCATTER_MAX_UQ24) {
        return "noise";
    }
    if (running(f) && a->gate_lsb_uq16 > (uint32_t)4096 << 16) {
        return "gate";
    }
    if (running(f) && filter_fx_abs32(a->mean_lsb_q24) > (uint32_t)128 << 24) {
        return "mean";
    }
    return broken_adaptive_memory(f);
}

law_facts_t law_facts_adaptive(void)
{
    return (law_facts_t){ ENVELOPE(0.0, 1.0, 200.0 / PAPER_TIME_CONSTANT, 0, ENVELOPE_NONE) USUAL, SETTLES_IN(90),
                          .restarts = true, .learns = true };
}
