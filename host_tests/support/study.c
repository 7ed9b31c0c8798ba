/* What the faults of support/faults.h do to the filters. */
#include "support/envelope.h"
#include "support/faults.h"
#include "support/roles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MEDIAN_WINDOW 5U

const char *contender_name(size_t contender)
{
    return contender == MEDIAN_PLAIN ? by_role("median5_{plain}") : filter_listed_name((filter_kind_t)contender);
}

static filter_kind_t kind_used_by(size_t contender)
{
    return contender == MEDIAN_PLAIN ? plain_kind() : (filter_kind_t)contender;
}

bool contender_begin(chain_t *chain, size_t contender, uint16_t rate_dhz, uint8_t range_g, int axis)
{
    bool good = chain_begin(chain, kind_used_by(contender), rate_dhz, range_g, axis);
    return good && (contender != MEDIAN_PLAIN || median_init(&chain->median, MEDIAN_WINDOW) == NULL);
}

static bool run_clean(study_t *study, size_t contender, int axis)
{
    chain_t chain;
    int32_t *x_lsb_q16 = malloc(study->clean->count * sizeof *x_lsb_q16);
    study->x_lsb_q16[contender][axis] = x_lsb_q16;
    if (x_lsb_q16 == NULL || !contender_begin(&chain, contender, study->rate_dhz, study->range_g, axis)) {
        return false;
    }
    for (size_t i = 0; i < study->clean->count; i++) {
        x_lsb_q16[i] = chain_sample(&chain, study->clean->rows[i].t_us, study->clean->rows[i].lsb[axis]);
        if (contender == robust_kind()) {
            study->reacquired += (chain.filter.flags & FILTER_REACQUIRED) != 0U;
        }
    }
    return true;
}

bool study_begin(study_t *study, const stream_t *clean, uint16_t rate_dhz, uint8_t range_g)
{
    memset(study, 0, sizeof *study);
    study->clean = clean;
    study->rate_dhz = rate_dhz;
    study->range_g = range_g;
    for (size_t contender = 0; contender < CONTENDERS; contender++) {
        for (int axis = 0; axis < 3; axis++) {
            if (!run_clean(study, contender, axis)) {
                study_end(study);
                return false;
            }
        }
    }
    return true;
}

void study_end(study_t *study)
{
    for (size_t contender = 0; contender < CONTENDERS; contender++) {
        for (int axis = 0; axis < 3; axis++) {
            free(study->x_lsb_q16[contender][axis]);
            study->x_lsb_q16[contender][axis] = NULL;
        }
    }
}

/*
 * A read that is wrong by a. Linear filters follow it by A^2 sum h^2. A filter that does not may follow a read that is
 * within its gate of three sigma, where the good one was too: |A| <= 6 sqrt(S). Else it loses at most the good read,
 * 3 sqrt(S) off, and takes no more than a soft gate of two sigma of the bad one: 2 sqrt(S) off, the good one in part
 * likewise: 16 S covers both. One at the rail of the range is missing for all. S from the gain of a Kalman filter
 * without a gate, w1 = 1 - R / S, which all two-state filters have in the steady state.
 */
static void predict(const chain_t *chain, double a, score_t *score)
{
    filter_probe_t probe;
    filter_probe(&chain->filter, &probe);
    double w1 = probe.gain_uq16 / 65536.0;
    double (*own_gain)(const filter_t *) = law_facts(kind_of(&chain->filter)).envelope.noise_gain;
    double gain = (own_gain != NULL) ? own_gain(&chain->filter) : noise_gain_of(w1);
    double s_lsb2 = chain_r_lsb2(chain) / (1.0 - w1);
    score->predicted += chain->clipped ? 0.0 : gain * a * a;
    score->allowed += gain * (a * a <= 36.0 * s_lsb2 ? a * a : 16.0 * s_lsb2);
}

static void score_axis(const study_t *study, const faulty_t *faulty, size_t contender, int axis, score_t *score)
{
    chain_t chain;
    (void)contender_begin(&chain, contender, study->rate_dhz, faulty->range_g, axis); /* study_begin did it before */
    const int32_t *own = study->x_lsb_q16[contender][axis];
    const int32_t *plain = study->x_lsb_q16[plain_kind()][axis];
    for (size_t i = 0; i < faulty->stream.count; i++) {
        const stream_row_t *row = &faulty->stream.rows[i];
        size_t source = faulty->source[i];
        int32_t x = chain_sample(&chain, row->t_us, row->lsb[axis]);
        double a = row->lsb[axis] - study->clean->rows[source].lsb[axis];
        if (source < FILTER_WARM_UP_SAMPLES) {
            continue;
        }
        double own_lsb = ((double)x - own[source]) / 65536.0;
        double plain_lsb = ((double)x - plain[source]) / 65536.0;
        score->own += own_lsb * own_lsb;
        score->plain += plain_lsb * plain_lsb;
        score->count++;
        if (a < 0.0 || a > 0.0) {
            predict(&chain, a, score);
        }
    }
}

void study_score(const study_t *study, const faulty_t *faulty, size_t contender, score_t *score)
{
    for (int axis = 0; axis < 3; axis++) {
        score_axis(study, faulty, contender, axis, score);
    }
}

double rms(double sum, size_t count)
{
    return count == 0 ? 0.0 : sqrt(sum / (double)count);
}
