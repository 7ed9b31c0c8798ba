/*
 * The yardstick of the benchmark: each filter of the list as one writes it with float from the textbook, and the
 * angles. Test only; never linked into the firmware. For a filter F of the list there are float_F_t and
 *
 *   void  float_F_start(float_F_t *f, const F_config_t *config, float x0_lsb);   runs from x0, as F after its warm-up
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

/* Variance of the rate at the start, (200 LSB/s)^2: the same as in two_state.c. */
#define FLOAT_START_RATE_VARIANCE_LSB2_S2 40000.0f

typedef struct {
    float x, v; /* LSB, LSB/s */
    float p00, p01, p10, p11;
    float dt, q, r; /* s, LSB^2/s^3, LSB^2 */
} float_kf_t;

typedef struct {
    float x, v;
    float p00, p01, p10, p11;
    float dt, q, r;
    float gate, rate_max, agree; /* sigmas (0: none), LSB/s, LSB */
    float previous, first;
    uint8_t run, reacquire;
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

void float_kf_start(float_kf_t *f, const kf_config_t *config, float x0_lsb);
void float_kf_set_noise(float_kf_t *f, float r_lsb2);
float float_kf_update(float_kf_t *f, int16_t z_lsb);
float float_kf_coast(float_kf_t *f);

void float_lrf_start(float_lrf_t *f, const lrf_config_t *config, float x0_lsb);
void float_lrf_set_noise(float_lrf_t *f, float r_lsb2);
float float_lrf_update(float_lrf_t *f, int16_t z_lsb);
float float_lrf_coast(float_lrf_t *f);

void float_soft_start(float_soft_t *f, const soft_config_t *config, float x0_lsb);
void float_soft_set_noise(float_soft_t *f, float r_lsb2);
float float_soft_update(float_soft_t *f, int16_t z_lsb);
float float_soft_coast(float_soft_t *f);

void float_sprf_start(float_sprf_t *f, const sprf_config_t *config, float x0_lsb);
void float_sprf_set_noise(float_sprf_t *f, float r_lsb2);
float float_sprf_update(float_sprf_t *f, int16_t z_lsb);
float float_sprf_coast(float_sprf_t *f);

void float_synth_start(float_synth_t *f, const synth_config_t *config, float x0_lsb);
void float_synth_set_noise(float_synth_t *f, float r_lsb2);
float float_synth_update(float_synth_t *f, int16_t z_lsb);
float float_synth_coast(float_synth_t *f);

/* Degrees. */
void float_angles(float *roll, float *pitch, float x, float y, float z);

#endif
