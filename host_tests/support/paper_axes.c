#include "support/paper_axes.h"

#include "support/roles.h"
#include "tracker.h"

#include <math.h>

#define START_LSB_S 200.0 /* deviation of the rate at the start, as kalman.c */
#define JOINT_LIMIT \
    14.156            /* chi-square with three degrees of freedom beyond it: as often as a normal one beyond 3 sigma */
#define RUNS_STAY 0.8 /* that an outlier follows an outlier */
#define REACQUIRE 5
#define MEDIAN_WINDOW 5

static const char *const names[PAPER_KINDS] = { "own_gates", "one_gate", "alone", "eq11" };

const char *paper_axes_name(paper_kind_t kind)
{
    return names[kind];
}

filter_kind_t paper_axes_law(paper_kind_t kind)
{
    filter_kind_t mixture = (filter_kind_t)(FILTER_KIND_COUNT - 1);
    if (kind == PAPER_ONE_GATE || kind == PAPER_OWN_GATES) {
        return robust_kind();
    }
    /* two can expect runs; the first one's gain is 0 for an outlier, so it may lock out in them */
    while (parameter_named(mixture, "stay") == FILTER_PARAMETERS_MAX) {
        mixture = (filter_kind_t)(mixture - 1);
    }
    return mixture;
}

/* The robust law's default. */
static double default_of(const filter_parameter_t *wanted, uint16_t rate_dhz)
{
    const filter_law_t *law = filter_listed(robust_kind());
    const filter_config_t config = filter_defaults(law, rate_dhz);
    for (uint8_t i = 0; i < filter_parameter_count(law); i++) {
        if (filter_parameter(law, i) == wanted) {
            return ldexp(config.value[i], -wanted->fraction_bits);
        }
    }
    return NAN;
}

/* R changes with the noise; what agrees does with it. */
static void set_noise(paper_axes_t *of, int axis)
{
    robust_reference_t *f = &of->axis[axis];
    f->r = filter_noise_r_lsb2_q8(&of->noise[axis]) / 256.0;
    f->agree = 3.0 * sqrt(2.0 * f->r) + f->rate_max;
}

void paper_axes_begin(paper_axes_t *of, paper_kind_t kind, uint16_t rate_dhz)
{
    double rate_hz = rate_dhz / 10.0;
    bool gated = paper_axes_law(kind) == robust_kind();
    of->kind = kind;
    for (int axis = 0; axis < 3; axis++) {
        robust_reference_t *f = &of->axis[axis];
        (void)robust_reference_table1(f, filter_listed_name(paper_axes_law(kind)));
        filter_noise_init(&of->noise[axis], rate_dhz, axis == 2);
        f->period_s = 1.0; /* time in samples */
        f->q[3] = default_of(&filter_parameter_q, rate_dhz) / pow(rate_hz, 3.0);
        f->rate_max = gated ? default_of(&filter_parameter_ratemax, rate_dhz) / rate_hz : 0.0;
        f->reacquire = gated ? REACQUIRE : 0;
        f->doubts = gated;
        f->stay = kind == PAPER_CHAIN ? RUNS_STAY : 0.0;
        f->median_window = MEDIAN_WINDOW;
        f->p22_start = pow(START_LSB_S / rate_hz, 2.0);
        set_noise(of, axis);
    }
}

static double one_gate(paper_axes_t *of, const int16_t lsb[3], int axis)
{
    const double z[3] = { lsb[0], lsb[1], lsb[2] };
    double x[3];
    for (int i = 0; i < 3; i++) {
        (void)filter_noise_update(&of->noise[i], lsb[i]);
        set_noise(of, i);
    }
    robust_reference_step_joint(of->axis, 3, z, JOINT_LIMIT, x);
    return x[axis];
}

double paper_axes_sample(paper_axes_t *of, const int16_t lsb[3], int axis)
{
    if (of->kind == PAPER_ONE_GATE) {
        return one_gate(of, lsb, axis);
    }
    (void)filter_noise_update(&of->noise[axis], lsb[axis]);
    set_noise(of, axis);
    return robust_reference_step(&of->axis[axis], lsb[axis]);
}
