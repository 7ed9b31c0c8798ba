/*
 * Double references of lib/filters, written from the matrix equations (Eigen), not from the scalar code; plain C
 * interface.
 */
#ifndef REFERENCE_FILTERS_H
#define REFERENCE_FILTERS_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* x = (position, rate per second), z = position + noise of variance r; white acceleration on the rate. */
typedef struct {
    double period_s;
    double r;        /* of the model */
    double r_gain;   /* of the update: r, or the linear robust filter's R_L */
    double q[4];     /* process noise per sample, row-major */
    double gate2;    /* squared gate in units of S; 0: none */
    double soft2;    /* squared soft gate in units of S; 0: none; beyond it S is raised to r^2 / soft2 */
    int reacquire;   /* consistent refused samples L; 0: never */
    double agree;    /* D of the consistency rule */
    bool doubts;     /* half of the rate is left by a refused sample where P11 >= R */
    double rate_max; /* 0: no limit */
    double x[2];
    double p[4];
    double innovation;
    double gain[2];
    bool gated;
    bool reacquired;
    int run;
    int refused;
    double first;
    double previous;
} reference_filter_t;

/* Prediction, gate, update, re-acquisition for one sample. */
void reference_step(reference_filter_t *f, double z);

/* Prediction only. */
void reference_coast(reference_filter_t *f);

/*
 * Variance of the position's error in the steady state when the filter's present gain meets noise of variance r_true.
 */
double reference_lyapunov(const reference_filter_t *f, double r_true);

/* Table 1 of paper 002, Q on the rate; the gain is for noise of so many times R: 1, or 60.85 (linear robust filter). */
reference_filter_t reference_table_1(double factor);

/* 5,000 zeros. */
void reference_settle(reference_filter_t *f);

/*
 * kf and sprf as lib/filters defines them (rate in LSB/s inside), running from x0 with P11 = R and the library's rate
 * spread.
 */
void reference_library(reference_filter_t *f, double rate_hz, double r, double q, double gate_sigma, int reacquire,
                       double rate_max, double x0);

#ifdef __cplusplus
}
#endif
#endif
