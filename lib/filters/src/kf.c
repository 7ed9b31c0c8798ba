/*
 * kf: two-state Kalman filter (position, rate), driven by white acceleration. Optimal for Gaussian noise; every outlier
 * passes with the full gain: the yardstick for the robust laws. Parameters r, q. Equations and scaling: kalman.h.
 *
 * lrf: linear robust filter (Volovyk et al., paper 002 equation (31)): kf with the mean variance of normal and outlying
 * samples, R_L = R (N^2 - q1 (N^2 - 1)), where q1 is the probability of a normal sample (clean) and N the sigma of an
 * outlier over that of a normal one (ratio); 60.85 R at the defaults. P is in units of R_L, which is limited to 65,536
 * LSB^2 and within 2^-13 of the formula. With ratio 1 it is kf. Its error variance is 0.49 of that of kf with 15 %
 * outliers of 20 sigma, and without outliers 5.8 times that of kf (kf / lrf = 0.1715; test_lrf_reference).
 */
#include "kalman.h"

/* The smallest q T^3 / R_L, 6e-8, is reached first: with the default q and R above 550 Hz. */
#define LRF_R_MAX_LSB2_Q8 0xFFFFFFU

LAW_PARAMETER(clean, "clean\0", 16, 0, 656, 65535, 55706);
LAW_PARAMETER(ratio, "ratio\0", 8, 0, 256, 8192, 5120);
static const filter_parameter_t *const parameters[] IN_FLASH = { &filter_parameter_r, &filter_parameter_q, &clean,
                                                                 &ratio };

static void kf_set_up(filter_t *f, const filter_config_t *config)
{
    filter_kalman_set_up(f, config, 0);
}

static void step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    (void)filter_kalman_step(f, z_lsb, what);
}

/* The factor is rounded to 2^-16. */
static void lrf_set_up(filter_t *f, const filter_config_t *config)
{
    uint16_t ratio_uq8 = (uint16_t)config->value[LRF_RATIO_UQ8];
    uint32_t square_uq16 = fx_product_u16(ratio_uq8, ratio_uq8);
    f->own.kalman.of.factor_uq16 = square_uq16 -
                                   filter_fx_mul_uq16(square_uq16 - 65536U, (uint16_t)config->value[LRF_CLEAN_UQ16]);
    filter_kalman_set_up(f, config, 0);
}

static void lrf_set_noise(filter_t *f, uint32_t r_lsb2_q8)
{
    fx_scaled_t product = filter_fx_scaled_mul(filter_fx_scaled(r_lsb2_q8),
                                               filter_fx_scaled(f->own.kalman.of.factor_uq16));
    product.exponent = (int8_t)(product.exponent - 16);
    uint32_t r_mixed_lsb2_q8 = filter_fx_scaled_fixed(product, 0);
    filter_kalman_set_variance(f, (r_mixed_lsb2_q8 > LRF_R_MAX_LSB2_Q8) ? LRF_R_MAX_LSB2_Q8 : r_mixed_lsb2_q8);
}

const filter_law_t filter_law_kf IN_FLASH = { .parameter_count = 2,
                                              .traits = LAW_COVARIANCE,
                                              .worst_cycles = 1080,
                                              .parameters = parameters,
                                              .set_up = kf_set_up,
                                              .set_noise = filter_kalman_set_variance,
                                              .start = filter_kalman_start,
                                              .step = step,
                                              .report = LAW_REPORT(filter_kalman_report),
                                              .name = "kf" };

const filter_law_t filter_law_lrf IN_FLASH = { .parameter_count = 4,
                                               .traits = LAW_COVARIANCE,
                                               .worst_cycles = 1080,
                                               .parameters = parameters,
                                               .set_up = lrf_set_up,
                                               .set_noise = lrf_set_noise,
                                               .start = filter_kalman_start,
                                               .step = step,
                                               .report = LAW_REPORT(filter_kalman_report),
                                               .name = "lrf" };
