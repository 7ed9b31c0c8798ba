/*
 * kf3: three-state Kalman filter (position, rate, acceleration), driven by white jerk: the model of order m = 2 of
 * paper 001, equation 1, whose "second-order Kalman filter" it is. No lag under constant acceleration, paid for with
 * noise; every outlier passes with the full gain: a yardstick. With P divided by R and everything per sample the
 * recursion is
 *
 *   predict  P33 += q33; a stays; v += a; x += v                                         q33 = q T^5 / R
 *   update   g = 1 / (P11 + 1); w1 = 1 - g; w2 = P12 g; w3 = P13 g; (x, v, a) += (w1, w2, w3) r
 *            P22 -= w2 P12; P23 -= w2 P13; P33 -= w3 P13; P12 = w2; P13 = w3; P11 = w1
 *
 * v and a are differences to the samples before: on x = a n^2 / 2 the rate is that of half a sample ago. Acceleration
 * walks at random (Singer's correlation is 1): with less the lag under constant acceleration, whose absence the filter
 * is for, would be back. Functions: see filter.h.
 *
 * A long gap: P is predicted until P11 reaches 4 R (or another element 1), then it stays and the acceleration is not
 * believed, so the estimate goes on along a straight line; at the bound of the format it stands still.
 */
#ifndef KF3_H
#define KF3_H

#include "two_state.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * From this rate on the acceleration is counted in sixteenths of an LSB per sample^2, because the drive falls with the
 * fifth power of the rate. q33 is limited to 2^-24..1 below this rate (gain 0.118..0.871) and to 2^-32..2^-11 from it
 * on (gain 0.048..0.430).
 */
#define KF3_FINE_FROM_DHZ 1000U

typedef struct {
    uint16_t rate_dhz;  /* output data rate, 0.1 Hz: 50..40000 */
    uint32_t r_lsb2_q8; /* measurement variance R, LSB^2: 0.01..1000 (3..256000); 0 is refused */
    uint32_t q_lsb2_s5; /* power density of the white jerk, LSB^2/s^5: 1..1e9; 0 is refused */
} kf3_config_t;

/* In this order the elements of P are within the reach of an 8-bit machine's addressing. */
typedef struct {
    bool fine;                /* the acceleration is counted in sixteenths */
    int32_t acceleration_q16; /* LSB per sample^2, in sixteenths when fine; |.| <= 4608 */
    uint32_t p13_uq28;        /* P / R of the acceleration in its unit */
    uint32_t p23_uq28;
    uint32_t p33_uq28;
    two_state_t core; /* x, rate, P11, P12, P22; its drive q22 is here q33, 256 times as much when fine */
} kf3_t;

/* Descriptor in program memory. */
extern const filter_descriptor_t kf3_descriptor;

enum { kf3_worst_cycles = 2350 }; /* of kf3_update, as in filter.h */

void kf3_defaults(kf3_config_t *config, uint16_t rate_dhz);
static inline bool kf3_together(const kf3_config_t *config)
{
    (void)config; /* each by itself */
    return true;
}

bool kf3_init(kf3_t *f, const kf3_config_t *config);
void kf3_configure(kf3_t *f, const kf3_config_t *config);
void kf3_set_noise(kf3_t *f, uint32_t r_lsb2_q8);
void kf3_reset(kf3_t *f, int16_t z0_lsb);
bool kf3_reset_step(kf3_t *f, int16_t z0_lsb, uint8_t step);
int32_t kf3_update(kf3_t *f, int16_t z_lsb);
int32_t kf3_coast(kf3_t *f);
void kf3_damp(kf3_t *f);
void kf3_hold(kf3_t *f);
void kf3_restart(kf3_t *f);
uint8_t kf3_flags(const kf3_t *f);
void kf3_probe(const kf3_t *f, filter_probe_t *out);

/* Its rate is worth more than one sample's noise. */
static inline void kf3_gap(kf3_t *f)
{
    (void)f;
}

#ifdef __cplusplus
}
#endif
#endif
