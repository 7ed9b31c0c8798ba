#include "support/robust_peers.h"

#include <math.h>
#include <string.h>

#define HUBER 1.345
#define FREEDOM 4.0
#define STEPS 3
#define KERNEL 3.0
#define LEAST_WEIGHT 1e-6

/* imm3: q and R of each model, and how probably one follows another. */
static const double q_times[ROBUST_MODELS] = { 1.0 / 30.0, 30.0, 1.0 };
static const double r_times[ROBUST_MODELS] = { 1.0, 1.0, 400.0 };
static const double follows[ROBUST_MODELS][ROBUST_MODELS] = { { 0.93, 0.04, 0.03 },
                                                              { 0.04, 0.93, 0.03 },
                                                              { 0.40, 0.40, 0.20 } };

static const char *const names[ROBUST_PEERS] = { "huber", "student_t", "correntropy", "imm3" };

const char *robust_peer_name(robust_kind_t kind)
{
    return names[kind];
}

void robust_peer_begin(robust_peer_t *peer, robust_kind_t kind, double r, double q, double rate_variance)
{
    memset(peer, 0, sizeof *peer);
    peer->kind = kind;
    peer->r = r;
    peer->q = q;
    for (int j = 0; j < ROBUST_MODELS; j++) {
        peer->state[j].p22 = rate_variance;
        peer->weight[j] = 1.0 / ROBUST_MODELS;
    }
}

void robust_peer_from(robust_peer_t *peer, const robust_state_t *state)
{
    peer->begun = true;
    for (int j = 0; j < ROBUST_MODELS; j++) {
        peer->state[j] = *state;
    }
}

static void predict(robust_state_t *s, double q)
{
    s->x += s->v;
    s->p11 += 2.0 * s->p12 + s->p22;
    s->p12 += s->p22;
    s->p22 += q;
}

static void correct(robust_state_t *s, double u, double r)
{
    double w1 = s->p11 / (s->p11 + r);
    double w2 = s->p12 / (s->p11 + r);
    s->x += w1 * u;
    s->v += w2 * u;
    s->p22 -= w2 * s->p12;
    s->p12 -= w1 * s->p12;
    s->p11 -= w1 * s->p11;
}

/* R that the sample deserves. */
static double weighed(const robust_peer_t *peer, const robust_state_t *s, double u)
{
    double sigmas = fabs(u) / sqrt(s->p11 + peer->r);
    if (peer->kind == ROBUST_HUBER) {
        return sigmas <= HUBER ? peer->r : peer->r * sigmas / HUBER;
    }
    if (peer->kind == ROBUST_CORRENTROPY) {
        return peer->r / fmax(exp(-0.5 * sigmas * sigmas / (KERNEL * KERNEL)), LEAST_WEIGHT);
    }
    double r = peer->r;
    for (int step = 0; step < STEPS; step++) {
        double kept = r / (s->p11 + r);
        double left = kept * u * kept * u + kept * s->p11;
        r = peer->r * (FREEDOM + left / peer->r) / (FREEDOM + 1.0);
    }
    return r;
}

/* --- imm3 --- */

static robust_state_t mixed(const robust_state_t *state, const double *share)
{
    robust_state_t m = { 0 };
    for (int i = 0; i < ROBUST_MODELS; i++) {
        m.x += share[i] * state[i].x;
        m.v += share[i] * state[i].v;
    }
    for (int i = 0; i < ROBUST_MODELS; i++) {
        double dx = state[i].x - m.x;
        double dv = state[i].v - m.v;
        m.p11 += share[i] * (state[i].p11 + dx * dx);
        m.p12 += share[i] * (state[i].p12 + dx * dv);
        m.p22 += share[i] * (state[i].p22 + dv * dv);
    }
    return m;
}

/* The states that the models start a sample from, and how probable each is before it. */
static void mix(const robust_peer_t *peer, robust_state_t *from, double *before)
{
    for (int j = 0; j < ROBUST_MODELS; j++) {
        double share[ROBUST_MODELS];
        before[j] = 0.0;
        for (int i = 0; i < ROBUST_MODELS; i++) {
            share[i] = follows[i][j] * peer->weight[i];
            before[j] += share[i];
        }
        for (int i = 0; i < ROBUST_MODELS; i++) {
            share[i] /= before[j];
        }
        from[j] = mixed(peer->state, share);
    }
}

static double three_models(robust_peer_t *peer, double z)
{
    robust_state_t from[ROBUST_MODELS];
    double weight[ROBUST_MODELS];
    double sum = 0.0;
    mix(peer, from, weight);
    for (int j = 0; j < ROBUST_MODELS; j++) {
        predict(&from[j], q_times[j] * peer->q);
        double r = r_times[j] * peer->r;
        double s = from[j].p11 + r;
        double u = z - from[j].x;
        correct(&from[j], u, r);
        weight[j] *= exp(fmax(-0.5 * u * u / s, -80.0)) / sqrt(s);
        sum += weight[j];
    }
    double x = 0.0;
    for (int j = 0; j < ROBUST_MODELS; j++) {
        peer->state[j] = from[j];
        peer->weight[j] = fmax(weight[j] / sum, LEAST_WEIGHT);
        x += weight[j] / sum * from[j].x;
    }
    return x;
}

double robust_peer_sample(robust_peer_t *peer, double z)
{
    if (!peer->begun) {
        robust_state_t first = { z, 0.0, peer->r, 0.0, peer->state[0].p22 };
        robust_peer_from(peer, &first);
        return z;
    }
    if (peer->kind == ROBUST_IMM) {
        return three_models(peer, z);
    }
    robust_state_t *s = &peer->state[0];
    predict(s, peer->q);
    double u = z - s->x;
    correct(s, u, weighed(peer, s, u));
    return s->x;
}
