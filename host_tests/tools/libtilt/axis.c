/* One filter on one axis, with any parameters: what a choice of parameters or of a filter is judged by. */
#include "libtilt.h"

#include <stdio.h>
#include <string.h>

#include "filter_list.h"
#include "noise.h"
#include "support/filters.h"

enum { MISSING = 0, AT_RAIL = 2, HOLD_PER_S = 10 };

int libtilt_filters(void)
{
    return FILTER_KIND_COUNT;
}

const char *libtilt_filter_name(int kind)
{
    return filter_listed_name((filter_kind_t)kind);
}

int libtilt_filter_cycles(int kind)
{
    return filter_worst_cycles(filter_listed((filter_kind_t)kind));
}

bool libtilt_filter_published_only(int kind)
{
    return law_facts((filter_kind_t)kind).published_only;
}

bool libtilt_parameter(int kind, int index, uint16_t rate_dhz, libtilt_parameter_t *out)
{
    const filter_law_t *law = filter_listed((filter_kind_t)kind);
    if (index >= filter_parameter_count(law)) {
        return false;
    }
    const filter_parameter_t *p = filter_parameter(law, (uint8_t)index);
    filter_config_t config = filter_defaults(law, rate_dhz);
    *out = (libtilt_parameter_t){ .min = p->min,
                                  .max = p->max,
                                  .value = config.value[index],
                                  .fraction_bits = p->fraction_bits,
                                  .zero_means_off = p->zero_means_off };
    (void)snprintf(out->name, sizeof out->name, "%s", p->words);
    (void)snprintf(out->unit, sizeof out->unit, "%s", p->words + strlen(p->words) + 1);
    return true;
}

typedef struct {
    filter_t filter;
    noise_t noise;
    uint32_t fixed_r_lsb2_q8; /* 0: estimated */
    uint32_t r_lsb2_q8;
    int64_t missing; /* samples on end */
    int64_t hold;    /* of them, until the filter no longer predicts */
} axis_t;

/* 100 ms of predictions, as the sample path; then the filter waits and starts anew. */
static void miss(axis_t *a)
{
    if (a->missing++ < a->hold) {
        (void)filter_missing(&a->filter);
        filter_noise_gap(&a->noise);
    } else {
        filter_restart(&a->filter);
    }
}

/* At the rail a sample tells nothing. */
static void take(axis_t *a, int16_t z_lsb, bool at_rail)
{
    a->missing = 0;
    if (at_rail) {
        (void)filter_missing(&a->filter);
        filter_noise_gap(&a->noise);
        return;
    }
    if (a->fixed_r_lsb2_q8 == 0 && filter_noise_update(&a->noise, z_lsb)) {
        a->r_lsb2_q8 = filter_noise_r_lsb2_q8(&a->noise);
        filter_set_noise(&a->filter, a->r_lsb2_q8);
    }
    (void)filter_update(&a->filter, z_lsb);
}

static void keep(const axis_t *a, uint8_t state, libtilt_probe_t *out)
{
    filter_probe_t probe = { 0 };
    filter_probe(&a->filter, &probe);
    *out = (libtilt_probe_t){ .x_lsb_q16 = probe.x_lsb_q16,
                              .rate_lsb_q16 = probe.rate_lsb_q16,
                              .innovation_lsb_q16 = probe.innovation_lsb_q16,
                              .p_lsb2_q8 = probe.p_lsb2_q8,
                              .gate_lsb2_q8 = probe.gate_lsb2_q8,
                              .r_lsb2_q8 = a->r_lsb2_q8,
                              .gain_uq16 = probe.gain_uq16,
                              .flags = probe.flags,
                              .judged = state != MISSING && state != AT_RAIL &&
                                        (probe.flags & FILTER_WARMING_UP) == 0 };
}

int libtilt_axis(int kind, uint16_t rate_dhz, const int64_t *values, const uint8_t *changed, uint32_t r_lsb2_q8,
                 bool noisy_axis, const int16_t *z_lsb, const uint8_t *state, int64_t count, libtilt_probe_t *out)
{
    const filter_law_t *law = filter_listed((filter_kind_t)kind);
    filter_config_t config = filter_defaults(law, rate_dhz);
    for (int i = 0; i < filter_parameter_count(law); i++) {
        if (changed[i]) {
            config.value[i] = (int32_t)values[i];
        }
    }
    axis_t axis = { .fixed_r_lsb2_q8 = r_lsb2_q8, .hold = rate_dhz / (10 * HOLD_PER_S) };
    filter_answer_t answer = filter_init(&axis.filter, law, &config);
    if (answer != FILTER_ACCEPTED) {
        return answer;
    }
    filter_noise_init(&axis.noise, rate_dhz, noisy_axis);
    axis.r_lsb2_q8 = r_lsb2_q8 != 0 ? r_lsb2_q8 : filter_noise_r_lsb2_q8(&axis.noise);
    filter_set_noise(&axis.filter, axis.r_lsb2_q8);
    for (int64_t i = 0; i < count; i++) {
        if (state[i] == MISSING) {
            miss(&axis);
        } else {
            take(&axis, z_lsb[i], state[i] == AT_RAIL);
        }
        keep(&axis, state[i], &out[i]);
    }
    return 0;
}
