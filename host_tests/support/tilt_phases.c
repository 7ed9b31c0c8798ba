/* Tilt streams of sixteen phases and the filters judged on them: see support/tilt_phases.h. */
#include "support/tilt_phases.h"
#include "support/laws.h"
#include "support/random.h"

#include <math.h>

#define PERIOD_S 0.1
#define PI 3.14159265358979323846
#define R_DEG2 (TILT_SIGMA_DEG * TILT_SIGMA_DEG)

static double between(test_random_t *random, double low, double high)
{
    return low + (high - low) * random_uniform(random);
}

/* Towards the middle, which keeps the walk from running away. */
static double slope_deg_s(test_random_t *random, double from_deg, double low, double high)
{
    return (from_deg > 0.0 ? -1.0 : 1.0) * between(random, low, high);
}

/* Both halves of the order hold each kind once. */
static void make_order(test_random_t *random, uint8_t *order)
{
    for (uint32_t half = 0; half < 2U; half++) {
        uint8_t *kinds = order + half * PHASES;
        for (uint8_t i = 0; i < PHASES; i++) {
            uint32_t at = random_below(random, i + 1U);
            kinds[i] = kinds[at];
            kinds[at] = i;
        }
    }
}

static void make_truth(test_random_t *random, uint8_t kind, double from_deg, double *truth_deg)
{
    double slope = 0.0;
    double bend = 0.0;
    double amplitude = 0.0;
    double omega = 0.0;
    if (kind == PHASE_RAMP) {
        slope = slope_deg_s(random, from_deg, 2.0, 8.0);
    } else if (kind == PHASE_MIXED) {
        slope = slope_deg_s(random, from_deg, 2.0, 6.0);
    } else if (kind == PHASE_SINE) {
        omega = 2.0 * PI / between(random, 4.0, 8.0);
        amplitude = between(random, 5.0, 20.0);
    } else if (kind == PHASE_ACCELERATION) {
        bend = slope_deg_s(random, from_deg, 4.0, 10.0);
    } else if (kind != PHASE_STILL && random_uniform(random) >= 0.5) {
        slope = slope_deg_s(random, from_deg, 1.0, 4.0);
    }
    double half_s = TILT_PHASE_SAMPLES / 2 * PERIOD_S;
    for (int i = 0; i < TILT_PHASE_SAMPLES; i++) {
        double t = (i + 1) * PERIOD_S;
        double late = fmax(0.0, t - half_s);
        double risen = bend * (t * t / 2.0 - late * late); /* the bend turns round in the middle */
        truth_deg[i] = from_deg + slope * t + amplitude * sin(omega * t) + risen;
    }
}

/* 12 % of the samples, and runs of one to four that begin with 5 % of them. */
static void add_outliers(test_random_t *random, double *z_deg)
{
    bool hit[TILT_PHASE_SAMPLES] = { false };
    for (int i = 0; i < TILT_PHASE_SAMPLES; i++) {
        hit[i] = hit[i] || random_uniform(random) < 0.12;
        if (random_uniform(random) < 0.05) {
            int end = i + 1 + (int)random_below(random, 4);
            for (int k = i; k < end && k < TILT_PHASE_SAMPLES; k++) {
                hit[k] = true;
            }
        }
    }
    for (int i = 0; i < TILT_PHASE_SAMPLES; i++) {
        z_deg[i] += hit[i] ? 20.0 * TILT_SIGMA_DEG * random_normal(random) : 0.0;
    }
}

static void drop_samples(test_random_t *random, bool *missing)
{
    int gap = 20 + (int)random_below(random, 70);
    for (int i = 0; i < TILT_PHASE_SAMPLES; i++) {
        missing[i] = random_uniform(random) < 0.25 || (i >= gap && i < gap + 15);
    }
}

void tilt_run_make(tilt_run_t *run, uint64_t seed)
{
    test_random_t random;
    random_seed(&random, seed);
    uint8_t order[2 * PHASES] = { 0 };
    make_order(&random, order);
    double x_deg = between(&random, -20.0, 20.0);
    for (int p = 0; p < 2 * PHASES; p++) {
        int from = p * TILT_PHASE_SAMPLES;
        uint8_t kind = order[p];
        make_truth(&random, kind, x_deg, run->truth_deg + from);
        x_deg = run->truth_deg[from + TILT_PHASE_SAMPLES - 1];
        double sigma = TILT_SIGMA_DEG * (kind == PHASE_VIBRATION ? between(&random, 3.0, 6.0) : 1.0);
        for (int i = from; i < from + TILT_PHASE_SAMPLES; i++) {
            run->z_deg[i] = run->truth_deg[i] + sigma * random_normal(&random);
            run->missing[i] = false;
            run->phase[i] = kind;
        }
        if (kind == PHASE_BURST || kind == PHASE_MIXED) {
            add_outliers(&random, run->z_deg + from);
        } else if (kind == PHASE_DROP) {
            drop_samples(&random, run->missing + from);
        }
    }
}

double tilt_rms(const tilt_errors_t *e, uint8_t phase)
{
    return sqrt(e->squares[phase] / e->counts[phase]);
}

double tilt_rms_of_all(const tilt_errors_t *e)
{
    double squares = 0.0;
    double counts = 0.0;
    for (uint8_t p = 0; p < PHASES; p++) {
        squares += e->squares[p];
        counts += e->counts[p];
    }
    return sqrt(squares / counts);
}

static void count_error(tilt_errors_t *e, const tilt_run_t *run, int i, double x_deg)
{
    if (i >= TILT_SETTLING && i < TILT_RUN_SAMPLES) {
        double error = x_deg - run->truth_deg[i];
        e->squares[run->phase[i]] += error * error;
        e->counts[run->phase[i]] += 1.0;
    }
}

static double degrees(int32_t x_lsb_q16)
{
    return x_lsb_q16 / 65536.0 / TILT_LSB_PER_DEGREE;
}

static void count_bank(tilt_bank_t *bank, const filter_t *f, const tilt_run_t *run, int i)
{
    if (i < TILT_SETTLING || i >= TILT_RUN_SAMPLES) {
        return;
    }
    for (uint8_t m = 0; m < AUTO_MEMBERS; m++) {
        count_error(&bank->members[m], run, i, degrees(f->own.bank.members[m].x_lsb_q16));
    }
    bank->chosen[f->own.bank.chosen] += 1.0;
    bank->phase_chosen[run->phase[i]][f->own.bank.chosen] += 1.0;
    bank->changes += (f->flags & FILTER_SWITCHED) != 0U;
}

void tilt_judge(const filter_t *begun, const tilt_run_t *run, tilt_errors_t *errors, tilt_bank_t *bank)
{
    filter_t f = *begun;
    for (int i = 0; i < TILT_RUN_SAMPLES; i++) {
        int32_t x;
        if (run->missing[i]) {
            if ((i == 0 || !run->missing[i - 1]) && f.collected == FILTER_RUNNING) {
                filter_tracker_fade(&f, true);
            }
            x = coast(&f);
        } else {
            x = filter_update(&f, as_sample(run->z_deg[i] * TILT_LSB_PER_DEGREE));
        }
        count_error(errors, run, i, degrees(x));
        if (bank != NULL) {
            count_bank(bank, &f, run, i);
        }
    }
}

/* --- the double references --- */

typedef struct {
    double x, v, p11, p12, p22;
} state_t;

static const state_t begun_state = { 0.0, 0.0, 400.0, 0.0, 100.0 };

static void predict(state_t *s, double q)
{
    const double t = PERIOD_S;
    s->x += t * s->v;
    s->p11 += 2.0 * t * s->p12 + t * t * s->p22 + q * t * t * t * t / 4.0;
    s->p12 += t * s->p22 + q * t * t * t / 2.0;
    s->p22 += q * t * t;
}

/* Kalman's update with a variance of the sample. */
static state_t updated(const state_t *s, double u, double variance)
{
    double g1 = s->p11 / (s->p11 + variance);
    double g2 = s->p12 / (s->p11 + variance);
    return (state_t){ s->x + g1 * u, s->v + g2 * u, s->p11 - g1 * s->p11, s->p12 - g1 * s->p12, s->p22 - g2 * s->p12 };
}

void tilt_judge_guarded(const tilt_guarded_t *how, const tilt_run_t *run, tilt_errors_t *errors)
{
    state_t s = begun_state;
    int refused = 0; /* on one side, with its sign */
    for (int i = 0; i < TILT_RUN_SAMPLES; i++) {
        predict(&s, how->q_deg2_s4);
        if (!run->missing[i]) {
            double u = run->z_deg[i] - s.x;
            if (how->gate_sigma > 0.0 && u * u > how->gate_sigma * how->gate_sigma * (s.p11 + R_DEG2)) {
                int side = (u > 0.0) ? 1 : -1;
                refused = (refused * side > 0) ? refused + side : side;
            } else {
                refused = 0;
            }
            if (refused * refused >= how->restart * how->restart) {
                s = (state_t){ s.x, 0.0, begun_state.p11, 0.0, begun_state.p22 };
                refused = 0;
            }
            if (refused == 0) {
                s = updated(&s, u, R_DEG2);
            }
        }
        count_error(errors, run, i, s.x);
    }
}

/* The two outcomes as one Gaussian of their mean and scatter. */
static state_t merged(const state_t *a, const state_t *b, double p)
{
    state_t m = { p * a->x + (1.0 - p) * b->x, p * a->v + (1.0 - p) * b->v, 0.0, 0.0, 0.0 };
    const state_t *both[2] = { a, b };
    for (int i = 0; i < 2; i++) {
        double w = (i == 0) ? p : 1.0 - p;
        double dx = both[i]->x - m.x;
        double dv = both[i]->v - m.v;
        m.p11 += w * (both[i]->p11 + dx * dx);
        m.p12 += w * (both[i]->p12 + dx * dv);
        m.p22 += w * (both[i]->p22 + dv * dv);
    }
    return m;
}

void tilt_judge_bayes(const tilt_bayes_t *how, const tilt_run_t *run, tilt_errors_t *errors)
{
    state_t s = begun_state;
    double wide = how->ratio * how->ratio * R_DEG2;
    for (int i = 0; i < TILT_RUN_SAMPLES; i++) {
        predict(&s, how->q_deg2_s4);
        if (!run->missing[i]) {
            double u = run->z_deg[i] - s.x;
            double narrow_s = s.p11 + R_DEG2;
            double wide_s = s.p11 + wide;
            double log_odds = log((1.0 - how->clean) / how->clean) + log(narrow_s / wide_s) / 2.0 +
                              u * u / 2.0 * (1.0 / narrow_s - 1.0 / wide_s);
            double p = 1.0 / (1.0 + exp(fmin(log_odds, 700.0)));
            state_t a = updated(&s, u, R_DEG2);
            state_t b = updated(&s, u, wide);
            s = merged(&a, &b, p);
        }
        count_error(errors, run, i, s.x);
    }
}
