/*
 * The yardstick of the benchmark: each filter of the list as one writes it with float from the textbook, and the
 * angles. Test only; never linked into the firmware. For a filter F of the list there are float_F_t and
 *
 *   void  float_F_start(float_F_t *f, const filter_config_t *config, float x0_lsb);   runs from x0, as F after its warm-up
 *   void  float_F_set_noise(float_F_t *f, float r_lsb2);
 *   float float_F_update(float_F_t *f, int16_t z_lsb);
 *   float float_F_coast(float_F_t *f);
 *
 * The benchmark iterates over FILTER_LIST: a filter without its yardstick does not build.
 */
#ifndef FLOAT_FILTERS_H
#define FLOAT_FILTERS_H

#include <stdbool.h>
#include <stdint.h>

#include "filter_list.h"

/* Variance of the rate at the start, (200 LSB/s)^2: the same as in kalman.c. */
#define FLOAT_START_RATE_VARIANCE_LSB2_S2 40000.0f

typedef struct {
    float x, v; /* LSB, LSB/s */
    float p00, p01, p10, p11;
    float dt, q, r; /* s, LSB^2/s^3, LSB^2 */
} float_kf_t;

typedef struct {
    float x, v, a; /* LSB, LSB/s, LSB/s^2 */
    float p[3][3];
    float dt, q, r;
    float q_given, per_q, least, most; /* as configured; T^5; the range of q T^5 / R */
} float_kf3_t;

typedef struct {
    float x, v;
    float p00, p01, p10, p11;
    float dt, q, r;
    float gate, rate_max, agree; /* sigmas (0: none), LSB/s, LSB */
    float previous, first;
    uint8_t run, refused, reacquire;
    bool broken;
} float_sprf_t;

typedef struct {
    float x, v;
    float p00, p01, p10, p11;
    float dt, q, r, factor; /* r: R_L, factor times that of a normal sample */
} float_lrf_t;

typedef struct {
    float x, v;
    float p00, p01, p10, p11;
    float dt, q, r;
    float soft, gate, rate_max, agree; /* sigmas (0: none) twice, LSB/s, LSB */
    float previous, first;
    uint8_t run, reacquire;
    bool broken;
} float_soft_t;

typedef struct {
    float x1, x2, x3;
    float a1, b0;
#ifdef FLOAT_SYNTH_KEPT
    float c1; /* 2 - a1 */
    float c2; /* 1 - 2 a1 */
#endif
} float_synth_t;

typedef struct {
    float x1, x2, x3;
    float s11, s12, s13, s22, s23, s33; /* covariance of the last three errors */
    float r;
    float p1, p2, p3, p4, p5; /* of variant U: past variances */
    bool u;
} float_synth_opt_t;

typedef struct {
    float x1, x2, x3, u1, memory;
    float a1, b0, b1, b2;
    float samples; /* of the start; 0: steady */
} float_synth_plus_t;

typedef struct {
    float x, v;
    float p00, p01, p10, p11;
    float dt, q, r;
    float gate; /* sigmas */
} float_sprf_paper_t;

typedef struct {
    float x, v;
    float p00, p01, p10, p11;
    float dt, q, r;
    float ratio2; /* N^2 */
    float clean;  /* probability of a normal sample */
    float count;  /* samples that it is learnt from; 0: given */
} float_mixture_t;
typedef float_mixture_t float_shrf_t;
typedef float_mixture_t float_pbf_t;
typedef float_mixture_t float_af_t;

typedef struct {
    float x, v; /* LSB, LSB per sample */
    float mean; /* of the innovations */
    float k;
    float scatter; /* LSB */
    float guard, slow, fast, share, manoeuvre, rate_max, confirm;
    float run;
    float previous;
    uint8_t terms; /* of the scatter, as far as its opening */
    bool broken, identify, below, term;
} float_adaptive_t;

typedef struct {
    float x, v, k, score; /* LSB, LSB per sample, 2 / memory, LSB^2 */
    int8_t refused;
} float_auto_member_t;

typedef struct {
    float_auto_member_t members[AUTO_MEMBERS];
    float final_k[AUTO_MEMBERS];
    float gate[AUTO_MEMBERS];
    float sigma, rate_max; /* LSB, LSB per sample */
    uint8_t chosen;
} float_auto_t;

void float_kf_start(float_kf_t *f, const filter_config_t *config, float x0_lsb);
void float_kf_set_noise(float_kf_t *f, float r_lsb2);
float float_kf_update(float_kf_t *f, int16_t z_lsb);
float float_kf_coast(float_kf_t *f);

void float_kf3_start(float_kf3_t *f, const filter_config_t *config, float x0_lsb);
void float_kf3_set_noise(float_kf3_t *f, float r_lsb2);
float float_kf3_update(float_kf3_t *f, int16_t z_lsb);
float float_kf3_coast(float_kf3_t *f);

void float_lrf_start(float_lrf_t *f, const filter_config_t *config, float x0_lsb);
void float_lrf_set_noise(float_lrf_t *f, float r_lsb2);
float float_lrf_update(float_lrf_t *f, int16_t z_lsb);
float float_lrf_coast(float_lrf_t *f);

void float_soft_start(float_soft_t *f, const filter_config_t *config, float x0_lsb);
void float_soft_set_noise(float_soft_t *f, float r_lsb2);
float float_soft_update(float_soft_t *f, int16_t z_lsb);
float float_soft_coast(float_soft_t *f);

void float_sprf_start(float_sprf_t *f, const filter_config_t *config, float x0_lsb);
void float_sprf_set_noise(float_sprf_t *f, float r_lsb2);
float float_sprf_update(float_sprf_t *f, int16_t z_lsb);
float float_sprf_coast(float_sprf_t *f);

void float_synth_start(float_synth_t *f, const filter_config_t *config, float x0_lsb);
void float_synth_set_noise(float_synth_t *f, float r_lsb2);
float float_synth_update(float_synth_t *f, int16_t z_lsb);
float float_synth_coast(float_synth_t *f);

void float_synth_opt_start(float_synth_opt_t *f, const filter_config_t *config, float x0_lsb);
void float_synth_opt_set_noise(float_synth_opt_t *f, float r_lsb2);
float float_synth_opt_update(float_synth_opt_t *f, int16_t z_lsb);
float float_synth_opt_coast(float_synth_opt_t *f);

void float_synth_plus_start(float_synth_plus_t *f, const filter_config_t *config, float x0_lsb);
void float_synth_plus_set_noise(float_synth_plus_t *f, float r_lsb2);
float float_synth_plus_update(float_synth_plus_t *f, int16_t z_lsb);
float float_synth_plus_coast(float_synth_plus_t *f);

void float_sprf_paper_start(float_sprf_paper_t *f, const filter_config_t *config, float x0_lsb);
void float_sprf_paper_set_noise(float_sprf_paper_t *f, float r_lsb2);
float float_sprf_paper_update(float_sprf_paper_t *f, int16_t z_lsb);
float float_sprf_paper_coast(float_sprf_paper_t *f);

void float_shrf_start(float_shrf_t *f, const filter_config_t *config, float x0_lsb);
void float_shrf_set_noise(float_shrf_t *f, float r_lsb2);
float float_shrf_update(float_shrf_t *f, int16_t z_lsb);
float float_shrf_coast(float_shrf_t *f);

void float_pbf_start(float_pbf_t *f, const filter_config_t *config, float x0_lsb);
void float_pbf_set_noise(float_pbf_t *f, float r_lsb2);
float float_pbf_update(float_pbf_t *f, int16_t z_lsb);
float float_pbf_coast(float_pbf_t *f);

void float_af_start(float_af_t *f, const filter_config_t *config, float x0_lsb);
void float_af_set_noise(float_af_t *f, float r_lsb2);
float float_af_update(float_af_t *f, int16_t z_lsb);
float float_af_coast(float_af_t *f);

void float_adaptive_start(float_adaptive_t *f, const filter_config_t *config, float x0_lsb);
void float_adaptive_set_noise(float_adaptive_t *f, float r_lsb2);
float float_adaptive_update(float_adaptive_t *f, int16_t z_lsb);
float float_adaptive_coast(float_adaptive_t *f);

void float_auto_start(float_auto_t *f, const filter_config_t *config, float x0_lsb);
void float_auto_set_noise(float_auto_t *f, float r_lsb2);
float float_auto_update(float_auto_t *f, int16_t z_lsb);
float float_auto_coast(float_auto_t *f);

/* What the three with two states of the channel share. */
void float_mixture_start(float_mixture_t *f, const filter_config_t *config, float x0_lsb);
float float_mixture_coast(float_mixture_t *f);

/* Prediction; the probability that the sample is normal, and the gains of the two cases. */
float float_mixture_weigh(float_mixture_t *f, int16_t z_lsb, float *innovation, float *normal, float *outlier);

/* x by m, P by m2, both per LSB^2. */
void float_mixture_apply(float_mixture_t *f, float innovation, float m, float m2);

/* Degrees. */
void float_angles(float *roll, float *pitch, float x, float y, float z);

#endif
