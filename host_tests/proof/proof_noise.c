/* The noise estimate: any int16, any state within its bounds; the same bounds afterwards. */
#include "eva.h"
#include "noise.h"

#define SAMPLE(z) (-4096 <= (z) <= 4095)
#define HISTORY_BOUND(n)                                                                          \
    (SAMPLE((n)->history_lsb[0]) && SAMPLE((n)->history_lsb[1]) && SAMPLE((n)->history_lsb[2]) && \
     SAMPLE((n)->history_lsb[3]) && SAMPLE((n)->history_lsb[4]))
/* 43690667 is 1000 LSB^2 / 1.5 in Q16; the floor stays below it for any rate. */
#define BOUND(n)                                                                                         \
    ((n)->floor_lsb2_q16 <= 65535 * 223 && (n)->mean_lsb2_q16 <= 43690667 && (n)->r_lsb2_q8 <= 256000 && \
     (n)->filled <= 5 && HISTORY_BOUND(n))

/*@ ensures BOUND(n); */
void filter_noise_init(noise_t *n, uint16_t rate_dhz, bool noisy_axis);
/*@ requires BOUND(n); ensures BOUND(n); */
void filter_noise_gap(noise_t *n);
/*@ requires BOUND(n); ensures BOUND(n); */
bool filter_noise_update(noise_t *n, int16_t z_lsb);

#include "noise.c"
#include "tracker.c"

static void any_noise(noise_t *n)
{
    n->floor_lsb2_q16 = ANY_U32(0, 65535UL * 223U);
    n->mean_lsb2_q16 = ANY_U32(0, MEAN_MAX_LSB2_Q16);
    n->r_lsb2_q8 = ANY_U32(0, 256000);
    for (uint8_t i = 0; i < HISTORY; i++) {
        n->history_lsb[i] = ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB);
    }
    n->filled = ANY_U8(0, HISTORY);
    n->spaced = ANY_BOOL();
    n->terms = ANY_U8(0, UINT8_MAX);
}

void proof_filter_noise_init(void)
{
    noise_t n;
    filter_noise_init(&n, ANY_U16(0, UINT16_MAX), ANY_BOOL());
    (void)filter_noise_r_lsb2_q8(&n);
}

void proof_filter_noise_gap(void)
{
    noise_t n;
    any_noise(&n);
    filter_noise_gap(&n);
}

void proof_filter_noise_update(void)
{
    noise_t n;
    any_noise(&n);
    (void)filter_noise_update(&n, ANY_Z());
}
