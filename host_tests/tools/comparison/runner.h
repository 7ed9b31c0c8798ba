/*
 * One contender of default_filter.c on one axis: those of support/faults.h, the peers, one that does nothing, and a
 * library that is not ours. Included once, behind comparison/fusion_pc.h or fusion_none.h.
 */
#ifndef RUNNER_H
#define RUNNER_H

#include "support/faults.h"
#include "support/paper_axes.h"
#include "support/peers.h"
#include "support/robust_axis.h"

#define ROBUST (CONTENDERS + (size_t)PEERS)
#define PAPER (ROBUST + (size_t)ROBUST_PEERS)
#define RAW (PAPER + (size_t)PAPER_KINDS)
#define FUSION (RAW + 1U)
#define ALL (RAW + 1U + FUSIONS)

static const double lsb_per_g[] = { 265.0, 265.0, 256.0 }; /* of the streams */

typedef struct {
    size_t contender;
    chain_t chain;
    peer_t peer;
    robust_axis_t robust;
    paper_axes_t paper;
    fusion_t fusion;
} runner_t;

/* False: a filter refuses the rate. */
static bool runner_begin(runner_t *runner, size_t contender, uint16_t rate_dhz, uint8_t range_g, int axis)
{
    runner->contender = contender;
    fusion_begin(&runner->fusion, (float)rate_dhz / 10.0f);
    if (contender < CONTENDERS) {
        return contender_begin(&runner->chain, contender, rate_dhz, range_g, axis);
    }
    if (contender < ROBUST) {
        peer_begin(&runner->peer, (peer_kind_t)(contender - CONTENDERS), rate_dhz / 10.0);
    } else if (contender < PAPER) {
        robust_axis_begin(&runner->robust, (robust_kind_t)(contender - ROBUST), rate_dhz, axis);
    } else if (contender < RAW) {
        paper_axes_begin(&runner->paper, (paper_kind_t)(contender - PAPER), rate_dhz);
    }
    return true;
}

static double runner_lsb(runner_t *runner, const stream_row_t *row, int axis)
{
    if (runner->contender == RAW) {
        return row->lsb[axis];
    }
    if (runner->contender == FUSION) {
        return fusion_gravity(&runner->fusion, row->lsb, axis) * lsb_per_g[axis];
    }
    if (runner->contender >= PAPER) {
        return paper_axes_sample(&runner->paper, row->lsb, axis);
    }
    if (runner->contender >= ROBUST) {
        return robust_axis_sample(&runner->robust, row->lsb[axis]);
    }
    if (runner->contender >= CONTENDERS) {
        return peer_sample(&runner->peer, row->lsb[axis]);
    }
    return chain_sample(&runner->chain, row->t_us, row->lsb[axis]) / 65536.0;
}

static const char *runner_name(size_t contender)
{
    if (contender >= RAW) {
        return contender == RAW ? "raw" : "fusion";
    }
    if (contender >= PAPER) {
        return paper_axes_name((paper_kind_t)(contender - PAPER));
    }
    if (contender >= ROBUST) {
        return robust_peer_name((robust_kind_t)(contender - ROBUST));
    }
    return contender < CONTENDERS ? contender_name(contender) : peer_name((peer_kind_t)(contender - CONTENDERS));
}

#endif
