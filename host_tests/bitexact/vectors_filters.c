/* Paths of the filters: random legal configurations, any calls. */
#include "support/filters.h"
#include "vectors.h"

enum { ITEMS = 2000, ITEMS_PER_CONFIG = 100 };

static filter_t filter;
static uint32_t random_state;

uint8_t filter_paths(void)
{
    return FILTER_KIND_COUNT;
}

vectors_path_t filter_path(uint8_t which)
{
    return (vectors_path_t){ filter_listed_name((filter_kind_t)which), linked_kind(which) == which ? ITEMS : 0 };
}

/* Every second configuration that of a board at 100 Hz, so that gates open and close as they do in use. */
static void begin(filter_kind_t kind, uint16_t index)
{
    uint32_t refused = 0;
    (void)init_default(&filter, kind, 1000);
    if ((index / ITEMS_PER_CONFIG & 1U) != 0U) {
        (void)init_random(&filter, kind, &random_state, &refused);
    }
}

static int16_t sample(uint16_t index)
{
    uint32_t v = vectors_random();
    if ((v & 0x70U) == 0U) { /* an outlier */
        return (int16_t)((int32_t)(v >> 16) - 32768);
    }
    return (int16_t)((int16_t)(index & 0x3FFU) + (int16_t)((v >> 16) & 15U));
}

static void call(uint16_t index)
{
    uint8_t what = (uint8_t)(vectors_random() >> 24);
    vectors_input(what);
    if (what < 17U) {
        vectors_output((uint32_t)filter_missing(&filter), 4);
    } else if (what == 17U) {
        filter_restart(&filter);
    } else if (what < 20U) {
        int16_t z = sample(index);
        vectors_input((uint16_t)z);
        filter_reset(&filter, z);
    } else if (what < 23U) {
        uint32_t r_lsb2_q8 = vectors_random() >> what;
        vectors_input(r_lsb2_q8);
        filter_set_noise(&filter, r_lsb2_q8);
    } else {
        int16_t z = sample(index);
        vectors_input((uint16_t)z);
        vectors_output((uint32_t)filter_update(&filter, z), 4);
    }
}

void filter_path_item(uint8_t which, uint16_t index)
{
    if (index == 0U) {
        random_state = vectors_random();
    }
    if (index % ITEMS_PER_CONFIG == 0U) {
        begin((filter_kind_t)which, index);
    }
    call(index);
    filter_probe_t probe = { 0 };
    filter_probe(&filter, &probe);
    vectors_output((uint32_t)probe.x_lsb_q16, 4);
    vectors_output((uint32_t)probe.rate_lsb_q16, 4);
    vectors_output((uint32_t)probe.innovation_lsb_q16, 4);
    vectors_output(probe.p_lsb2_q8, 4);
    vectors_output(probe.gate_lsb2_q8, 4);
    vectors_output(probe.gain_uq16, 2);
    vectors_output(filter.flags, 1);
    filter_t state = filter;
    state.law = NULL; /* an address */
    vectors_state(&state, sizeof state);
}
