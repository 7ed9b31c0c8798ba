/*
 * Paper 002's filters in double (reference/robust_joint.h) on the three axes of the sensor: the defaults of the shipped
 * laws, the firmware's noise estimate. PC only.
 *
 *   one_gate   the robust one, {robust} of support/roles.h, with one gate over all three axes in place of one for each,
 *              of the same false alarms: y and H(k) of the paper
 *   eq11       the mixture that expects outliers in runs, by (11), one after another with 0.8
 *   own_gates, alone   the same without these two changes, what each is to be set beside: they give what the shipped
 *              laws give, to 0.005 of an RMS where no sample is missing (test_paper_axes.c). All know no gaps and rails
 */
#ifndef SUPPORT_PAPER_AXES_H
#define SUPPORT_PAPER_AXES_H

#include "filter_list.h"
#include "noise.h"
#include "reference/robust_joint.h"

typedef enum { PAPER_OWN_GATES, PAPER_ONE_GATE, PAPER_ALONE, PAPER_CHAIN, PAPER_KINDS } paper_kind_t;

typedef struct {
    paper_kind_t kind;
    robust_reference_t axis[3];
    noise_t noise[3];
} paper_axes_t;

const char *paper_axes_name(paper_kind_t kind);

/* What it is in the library. */
filter_kind_t paper_axes_law(paper_kind_t kind);

void paper_axes_begin(paper_axes_t *of, paper_kind_t kind, uint16_t rate_dhz);

/* One sample of all axes in, the estimate of one out; that of the others is kept up as far as its gate needs it. */
double paper_axes_sample(paper_axes_t *of, const int16_t lsb[3], int axis);

#endif
