/*
 * Any legal configuration of any filter, any sequence of calls. Holds what filter.h promises of every filter, and of
 * each filter the bounds that its own header states: broken_bound of support/filters.h, where a filter of the list that
 * has no bounds does not compile.
 *
 * Input: kind, rate, a byte per parameter (its place in the legal range) and then calls, an operation byte each.
 */
#include <string.h>

#include "filter_list.h"
#include "fuzz.h"
#include "noise.h"
#include "support/filters.h"

enum { ALL_FLAGS = FILTER_GATED | FILTER_COASTED | FILTER_REACQUIRED | FILTER_SATURATED | FILTER_WARMING_UP };

/* After each call: x is the estimate that the last update or coast gave, or that a reset set. */
static void check(const filter_t *f, int32_t x)
{
    filter_probe_t probe;
    memset(&probe, 0, sizeof probe);
    filter_probe(f, &probe);
    const char *broken = broken_bound(f, &probe, x);
    FUZZ_CHECK(broken == NULL, "filter %u: outside its bounds: %s", (unsigned)kind_of(f), broken);
    uint8_t own = law_facts(kind_of(f)).switches ? FILTER_SWITCHED : 0;
    FUZZ_CHECK((probe.flags & (uint8_t) ~(ALL_FLAGS | own)) == 0, "flags %u", probe.flags);
}

/* Linear or by powers of two, so that both ends are likely; the ends themselves for 0 and 255. */
static uint32_t within(uint32_t min, uint32_t max, uint8_t place)
{
    if (place >= 254) {
        return place == 255 ? max : max - (max != min);
    }
    if (place % 2 != 0) {
        return min + (uint32_t)((uint64_t)(max - min) * place / 255u);
    }
    uint32_t above = (uint32_t)(((uint64_t)1 << (place / 8u)) - 1u) + place;
    return place == 0 || above > max - min ? min : min + above;
}

/* A configuration that the filter takes; parameters that do not go together leave the defaults that every rate has. */
static void init(filter_t *f, fuzz_input_t *in)
{
    filter_kind_t kind = (filter_kind_t)(fuzz_u8(in) % FILTER_KIND_COUNT);
    const filter_law_t *law = filter_listed(kind);
    uint16_t rate_dhz = (uint16_t)within(FILTER_RATE_MIN_DHZ, FILTER_RATE_MAX_DHZ, fuzz_u8(in));
    filter_config_t config = filter_defaults(law, rate_dhz);
    for (uint8_t i = 0; i < parameter_count(kind); i++) {
        filter_parameter_t p = parameter_at(kind, i);
        uint8_t place = fuzz_u8(in);
        bool off = p.zero_means_off != 0 && place == 1;
        int32_t before = config.value[i];
        config.value[i] = off ? 0 : (int32_t)within((uint32_t)p.min, (uint32_t)p.max, place);
        if (filter_init(f, law, &config) != FILTER_ACCEPTED) {
            config.value[i] = before;
        }
    }
    FUZZ_CHECK(filter_init(f, law, &config) == FILTER_ACCEPTED || init_default(f, kind, rate_dhz),
               "filter %d refuses its defaults at %u dHz", (int)kind, rate_dhz);
}

static int16_t sample(fuzz_input_t *in, uint8_t operation)
{
    static const int16_t edge[] = { INT16_MIN, -4096, -1, 0, 1, 4095, INT16_MAX, 256 };
    return operation & 0x08 ? edge[operation >> 4 & 7] : (int16_t)fuzz_u16(in);
}

/* A sample missing, or the filter warms up again; returns the estimate. */
static int32_t miss(filter_t *f, uint8_t operation)
{
    if (operation >> 5 == 3) {
        filter_restart(f);
        return estimate_of(f);
    }
    return filter_missing(f);
}

/* One call; returns the estimate after it. */
static int32_t call(filter_t *f, uint8_t operation, int16_t z, uint32_t r, int32_t x)
{
    switch (operation & 7) {
    case 5:
        return miss(f, operation);
    case 6:
        filter_set_noise(f, r);
        return x;
    case 7:
        filter_reset(f, z);
        return (int32_t)filter_tracker_limited_z(z) * 65536;
    default:
        return filter_update(f, z);
    }
}

static int32_t call_both(filter_t *f, filter_t *twin, fuzz_input_t *in, int32_t x)
{
    uint8_t operation = fuzz_u8(in);
    unsigned times = (operation & 7) == 4 || (operation & 7) == 5 ? 1u + fuzz_u8(in) : 1u;
    int16_t z = (operation & 7) == 5 || (operation & 7) == 6 ? 0 : sample(in, operation);
    uint32_t r = (operation & 7) == 6 ? fuzz_u32(in) >> (operation >> 3) : 0;
    for (; times != 0; times--) {
        int32_t y = call(twin, operation, z, r, x);
        x = call(f, operation, z, r, x);
        FUZZ_CHECK(x == y, "the copy gives %ld, the original %ld", (long)y, (long)x);
        check(f, x);
    }
    filter_probe_t a;
    filter_probe_t b;
    memset(&a, 0, sizeof a);
    memset(&b, 0, sizeof b);
    filter_probe(f, &a);
    filter_probe(twin, &b);
    FUZZ_CHECK(memcmp(&a, &b, sizeof a) == 0, "the copy differs from the original");
    return x;
}

/* The estimate of R beside the filter, as the firmware runs it. */
static void noise_too(noise_t *n, int16_t z)
{
    bool changed = filter_noise_update(n, z);
    uint32_t r = filter_noise_r_lsb2_q8(n);
    FUZZ_CHECK(r >= FILTER_R_MIN_LSB2_Q8 && r <= FILTER_R_MAX_LSB2_Q8, "R %lu, changed %d", (unsigned long)r, changed);
    FUZZ_CHECK(n->mean_lsb2_q16 >= n->floor_lsb2_q16, "mean %lu below its floor", (unsigned long)n->mean_lsb2_q16);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input_t in = { data, size, 0 };
    filter_t f;
    memset(&f, 0, sizeof f);
    init(&f, &in);
    int32_t x = 0;
    check(&f, x);
    noise_t noise;
    filter_noise_init(&noise, (uint16_t)within(125, 8000, fuzz_u8(&in)), size % 2 != 0);
    filter_t twin = f;
    for (unsigned calls = 0; fuzz_more(&in); calls++) {
        if (calls % 16 == 15) {
            twin = f;
        }
        noise_too(&noise, (int16_t)(in.data[in.at] * 257));
        x = call_both(&f, &twin, &in, x);
    }
    return 0;
}
