#include "support/survey.h"

#include "support/filters.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool all_equal(const int16_t *lsb, int16_t value)
{
    return lsb[0] == value && lsb[1] == value && lsb[2] == value;
}

row_counts_t survey_rows(const stream_t *stream, uint8_t range_g)
{
    row_counts_t counts = { .rows = stream->count };
    int rail = range_g * 256;
    for (size_t i = 0; i < stream->count; i++) {
        const int16_t *lsb = stream->rows[i].lsb;
        bool clipped = false;
        for (int axis = 0; axis < 3; axis++) {
            clipped = clipped || lsb[axis] <= -rail || lsb[axis] >= rail - 1;
        }
        counts.clipped += clipped;
        counts.duplicates += i > 0 && memcmp(lsb, stream->rows[i - 1].lsb, sizeof stream->rows[i].lsb) == 0;
        counts.zeros += all_equal(lsb, 0);
        counts.ones += all_equal(lsb, -1);
    }
    return counts;
}

/* The state of one run. */
typedef struct {
    const survey_t *survey;
    envelope_facts_t facts;
    chain_t chain;
    band_t band;
    band_t second; /* the last second */
    hull_t hull;
    bool begun; /* the filter began anew behind a hold */
    int16_t *z_lsb;
    size_t count;
    double r_max_lsb2;
    size_t gated_run;
    size_t refused;  /* samples refused since the last that the filter followed */
    size_t missing;  /* and missing meanwhile */
    size_t unbroken; /* samples since the last missing one */
    axis_counts_t *counts;
} run_t;

/* For so many samples the filter may have gone on by the limit of its rate. */
static size_t samples_by_rate(const run_t *run)
{
    bool ends = run->facts.rule == ENVELOPE_STANDS && run->refused > RATE_HELD_SAMPLES;
    return run->missing + (ends ? RATE_HELD_SAMPLES : run->refused);
}

/* How much of what its rule allows the filter used; negative: the rule does not apply here. */
static double share_used(run_t *run, double x_lsb)
{
    uint16_t rate_dhz = run->survey->rate_dhz;
    size_t window = band_window(kind_of(&run->chain.filter), rate_dhz, run->r_max_lsb2);
    band_add(&run->band, run->z_lsb, window);
    double spread_lsb = band_spread_lsb(&run->band);
    double distance_lsb = fabs(x_lsb - band_median_lsb(&run->band));
    bool full = run->band.end - run->band.start >= window;
    switch (run->facts.rule) {
    case ENVELOPE_WAITS:
        return (double)run->gated_run / longest_wait_samples(rate_dhz, run->r_max_lsb2);
    case ENVELOPE_REACQUIRES:
    case ENVELOPE_STANDS:
        spread_lsb += gate_reach_lsb(run->r_max_lsb2) + (double)samples_by_rate(run) * rate_max_lsb(rate_dhz);
        return full && run->refused + run->missing < window ? distance_lsb / spread_lsb : -1.0;
    case ENVELOPE_FIXED_GAIN:
        full = full && run->unbroken >= window;
        break;
    case ENVELOPE_NONE:
        return -1.0;
    default:
        break;
    }
    double allowed_lsb = run->facts.gain_sum * BAND_GAIN_ALLOWANCE * spread_lsb + BAND_MARGIN_LSB;
    return full ? distance_lsb / allowed_lsb : -1.0;
}

static void judge_envelope(run_t *run, double x_lsb)
{
    double share = share_used(run, x_lsb);
    run->counts->envelope_judged += share >= 0.0;
    run->counts->envelope_broken += share > 1.0;
    run->counts->envelope_worst = fmax(run->counts->envelope_worst, share);
}

static void measure_outside(run_t *run, double x_lsb)
{
    band_add(&run->second, run->z_lsb, run->survey->rate_dhz / 10U);
    double outside_lsb = band_outside_lsb(&run->second, x_lsb);
    run->counts->outside += outside_lsb > gate_reach_lsb(chain_r_lsb2(&run->chain));
    run->counts->outside_worst_lsb = fmax(run->counts->outside_worst_lsb, outside_lsb);
}

static void judge_hull(run_t *run, int16_t lsb, double x_lsb)
{
    hull_add(&run->hull, lsb, chain_r_lsb2(&run->chain), run->chain.coasts);
    double left_lsb;
    bool has_hull = run->facts.rule == ENVELOPE_REACQUIRES || run->facts.rule == ENVELOPE_STANDS;
    if (!has_hull || !hull_judge(&run->hull, run->survey->rate_dhz, x_lsb, &left_lsb)) {
        return;
    }
    run->counts->hull_left_lsb = run->counts->hull_judged == 0 ? left_lsb : fmin(run->counts->hull_left_lsb, left_lsb);
    run->counts->hull_judged++;
    run->counts->hull_broken += left_lsb < 0.0;
}

static void count_flags(run_t *run, uint8_t flags)
{
    axis_counts_t *counts = run->counts;
    counts->samples++;
    counts->gated += (flags & FILTER_GATED) != 0U;
    counts->reacquired += (flags & FILTER_REACQUIRED) != 0U;
    counts->saturated += (flags & FILTER_SATURATED) != 0U;
    if ((flags & FILTER_REACQUIRED) != 0U) {
        counts->last_reacquired_s = (double)run->count * 10.0 / run->survey->rate_dhz;
    }
    bool gated = (flags & FILTER_GATED) != 0U;
    run->gated_run = gated ? run->gated_run + 1 : 0;
    counts->longest_gated = run->gated_run > counts->longest_gated ? run->gated_run : counts->longest_gated;
    run->refused = gated ? run->refused + 1 : 0;
    run->missing = gated ? run->missing + run->chain.coasts : 0;
    run->unbroken = run->chain.coasts == 0 ? run->unbroken + 1 : 0;
}

/* The rules see none of the samples before. */
static void begin_rules(run_t *run)
{
    band_clear(&run->band);
    band_clear(&run->second);
    run->band.start = run->band.end = run->second.start = run->second.end = run->count - 1;
    run->hull.filled = 0;
    run->gated_run = run->refused = run->missing = run->unbroken = 0;
    run->begun = false;
}

static void one_sample(run_t *run, uint64_t t_us, int16_t lsb)
{
    int32_t x_lsb_q16 = chain_sample(&run->chain, t_us, lsb);
    run->begun = run->begun || run->chain.begun;
    if (run->chain.waits) {
        run->hull.filled = run->chain.clipped ? 0 : run->hull.filled; /* on a reading at the rail no filter restarts */
        return;
    }
    filter_probe_t probe;
    filter_probe(&run->chain.filter, &probe);
    const char *broken = broken_bound(&run->chain.filter, &probe, x_lsb_q16);
    if (broken != NULL) {
        run->counts->first_broken = run->counts->bounds_broken++ == 0 ? broken : run->counts->first_broken;
    }
    run->r_max_lsb2 = fmax(run->r_max_lsb2, chain_r_lsb2(&run->chain));
    run->z_lsb[run->count++] = lsb;
    if ((probe.flags & FILTER_WARMING_UP) != 0U) {
        return;
    }
    count_flags(run, probe.flags);
    if (run->counts->samples == 1 || run->begun) { /* the first after a warm-up */
        begin_rules(run);
    }
    judge_envelope(run, x_lsb_q16 / 65536.0);
    measure_outside(run, x_lsb_q16 / 65536.0);
    judge_hull(run, lsb, x_lsb_q16 / 65536.0);
}

bool survey_axis(const stream_t *stream, const survey_t *survey, filter_kind_t kind, int axis, axis_counts_t *counts)
{
    static run_t run; /* too large for the stack */
    memset(&run, 0, sizeof run);
    memset(counts, 0, sizeof *counts);
    run.survey = survey;
    run.facts = law_facts(kind).envelope;
    run.counts = counts;
    run.z_lsb = malloc(stream->count * sizeof *run.z_lsb);
    bool good = run.z_lsb != NULL && chain_begin(&run.chain, kind, survey->rate_dhz, survey->range_g, axis);
    for (size_t i = 0; good && i < stream->count; i++) {
        const stream_row_t *row = &stream->rows[i];
        double t_s = 1e-6 * (double)row->t_us;
        if (!row->missing && t_s >= survey->from_s && t_s < survey->to_s) {
            one_sample(&run, row->t_us, row->lsb[axis]);
        }
    }
    free(run.z_lsb);
    return good;
}

tails_t survey_tails(const stream_t *stream, double from_s, double to_s, int axis)
{
    tails_t tails = { 0 };
    double mean = 0.0;
    double square = 0.0;
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < stream->count; i++) {
            double t_s = 1e-6 * (double)stream->rows[i].t_us;
            double d = fabs(stream->rows[i].lsb[axis] - mean);
            if (t_s < from_s || t_s >= to_s) {
                continue;
            }
            if (pass == 0) {
                tails.samples++;
                square += (double)stream->rows[i].lsb[axis] * stream->rows[i].lsb[axis];
                tails.sd_lsb += stream->rows[i].lsb[axis];
            } else {
                tails.beyond3 += d > 3.0 * tails.sd_lsb;
                tails.beyond5 += d > 5.0 * tails.sd_lsb;
            }
        }
        if (pass == 0 && tails.samples > 0) {
            mean = tails.sd_lsb / (double)tails.samples;
            tails.sd_lsb = sqrt(fmax(0.0, square / (double)tails.samples - mean * mean));
        }
    }
    tails.beyond3 /= fmax(1.0, (double)tails.samples);
    tails.beyond5 /= fmax(1.0, (double)tails.samples);
    return tails;
}
