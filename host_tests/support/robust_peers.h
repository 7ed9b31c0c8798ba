/*
 * Robust filters from the literature beside ours: a Kalman filter of position and rate whose sample counts the less the
 * farther off it is, and one of three models. One axis, in double; time is counted in samples. Also built for the chip,
 * where double is float, to be timed there.
 *
 *   huber         R by 1.345 / |u| beyond that many standard deviations of the innovation u
 *   student_t     noise of four degrees of freedom, by three variational steps (R falls or rises with what is left)
 *   correntropy   R by exp(-u^2 / (2 x 3^2)), u in standard deviations: the Gaussian kernel of width 3
 *   imm3          interacting multiple models: at rest (q / 30), moving (30 q), a bad sample (400 R)
 */
#ifndef SUPPORT_ROBUST_PEERS_H
#define SUPPORT_ROBUST_PEERS_H

#include <stdbool.h>

typedef enum { ROBUST_HUBER, ROBUST_STUDENT, ROBUST_CORRENTROPY, ROBUST_IMM, ROBUST_PEERS } robust_kind_t;

#define ROBUST_MODELS 3

typedef struct {
    double x, v;          /* estimate, and its change per sample */
    double p11, p12, p22; /* variances of their errors */
} robust_state_t;

typedef struct {
    robust_kind_t kind;
    double r; /* variance of a sample; may change */
    double q; /* variance of what the rate grows by in a sample */
    bool begun;
    robust_state_t state[ROBUST_MODELS]; /* one but for imm3 */
    double weight[ROBUST_MODELS];
} robust_peer_t;

const char *robust_peer_name(robust_kind_t kind);

/* rate_variance: of the rate at the start. Begins at the first sample. */
void robust_peer_begin(robust_peer_t *peer, robust_kind_t kind, double r, double q, double rate_variance);

/* Begins from this estimate, which is one sample old. */
void robust_peer_from(robust_peer_t *peer, const robust_state_t *state);

/* One sample in, the estimate out. */
double robust_peer_sample(robust_peer_t *peer, double z);

#endif
