/*
 * Tilt streams of sixteen phases of 12 s at 10 Hz, each of eight kinds twice in a random order, and the filters that
 * `auto` is compared with on them: errors against the truth, by kind of phase. PC only, double, fixed seeds.
 */
#ifndef SUPPORT_TILT_PHASES_H
#define SUPPORT_TILT_PHASES_H

#include "filter_list.h"

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum tilt_phase {
    PHASE_STILL,
    PHASE_RAMP,         /* 2-8 degree/s */
    PHASE_SINE,         /* 5-20 degree, 4-8 s */
    PHASE_VIBRATION,    /* noise times 3-6; here and in the next two at rest or on a ramp of 1-4 degree/s */
    PHASE_DROP,         /* a quarter of the samples missing, and 1.5 s on end */
    PHASE_BURST,        /* outliers of 20 sigma, 12 % and runs of one to four */
    PHASE_ACCELERATION, /* 4-10 degree/s^2, first half up, second half down */
    PHASE_MIXED,        /* outliers as above on a ramp of 2-6 degree/s */
    PHASES
};

#define TILT_PHASE_SAMPLES 120
#define TILT_RUN_SAMPLES (16 * TILT_PHASE_SAMPLES)
#define TILT_RATE_DHZ 100U
#define TILT_SIGMA_DEG 0.7
/* Samples at the start that are not judged. */
#define TILT_SETTLING 60

/* 256 LSB per g near level: what a tilted board's axis reads. */
#define TILT_LSB_PER_DEGREE 4.468042885105484

/* R of the streams as the filters are told it, LSB^2 in Q8. */
#define TILT_R_LSB2_Q8 \
    ((uint32_t)(TILT_SIGMA_DEG * TILT_SIGMA_DEG * TILT_LSB_PER_DEGREE * TILT_LSB_PER_DEGREE * 256.0 + 0.5))

typedef struct {
    double truth_deg[TILT_RUN_SAMPLES];
    double z_deg[TILT_RUN_SAMPLES];
    bool missing[TILT_RUN_SAMPLES];
    uint8_t phase[TILT_RUN_SAMPLES]; /* tilt_phase */
} tilt_run_t;

/* The same run for the same seed. */
void tilt_run_make(tilt_run_t *run, uint64_t seed);

/* Sums of squared errors in degree^2 and their numbers. */
typedef struct {
    double squares[PHASES];
    double counts[PHASES];
} tilt_errors_t;

double tilt_rms(const tilt_errors_t *e, uint8_t phase);
double tilt_rms_of_all(const tilt_errors_t *e);

/* What shows of `auto` beside its error: those of its members, samples that each is chosen for, changes. */
typedef struct {
    tilt_errors_t members[AUTO_MEMBERS];
    double chosen[AUTO_MEMBERS];
    double phase_chosen[PHASES][AUTO_MEMBERS];
    double changes;
} tilt_bank_t;

/* A filter of the list over a run, predicting what is missing, without the damping and the hold of filter_missing. */
void tilt_judge(const filter_t *begun, const tilt_run_t *run, tilt_errors_t *errors, tilt_bank_t *bank);

/*
 * In double, on the model of the notes, x_e = x + T v, Q = q [T^2/2, T] [T^2/2, T]': the Kalman filter with a gate in
 * sigmas of the innovation that restarts after so many refused samples on one side, and the pseudo-Bayesian filter for
 * samples that are normal with probability clean, else of `ratio` times the sigma.
 */
typedef struct {
    double q_deg2_s4;
    double gate_sigma; /* 0: none */
    int restart;
} tilt_guarded_t;
void tilt_judge_guarded(const tilt_guarded_t *how, const tilt_run_t *run, tilt_errors_t *errors);

typedef struct {
    double q_deg2_s4;
    double clean;
    double ratio;
} tilt_bayes_t;
void tilt_judge_bayes(const tilt_bayes_t *how, const tilt_run_t *run, tilt_errors_t *errors);

#ifdef __cplusplus
}
#endif
#endif
