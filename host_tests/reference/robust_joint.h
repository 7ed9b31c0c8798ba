/* Paper 002's gate with y and H(k) as they stand in (30): one decision for several components. */
#ifndef REFERENCE_ROBUST_JOINT_H
#define REFERENCE_ROBUST_JOINT_H

#include "reference/robust.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * One sample of each of several filters with a gate, of which all or none is taken: with states of their own
 * r' Xi1^-1 r is the sum of theirs, at most limit. They restart together, too.
 */
void robust_reference_step_joint(robust_reference_t *f, int count, const double *z, double limit, double *x);

#ifdef __cplusplus
}
#endif
#endif
