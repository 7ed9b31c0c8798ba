/*
 * Any legal configuration of any filter, any sequence of calls. Holds what filter.h promises of every filter, and of each
 * filter the bounds that its own header states; a filter without a bounds_NAME below does not build.
 *
 * Input: kind, rate, a byte per parameter (its place in the legal range) and then calls, an operation byte each.
 */
#include <string.h>

#include "filter_any.h"
#include "fuzz.h"
#include "noise.h"

static const int32_t x_max_lsb_q16 = (int32_t)FILTER_X_MAX_LSB * 65536;

enum { ALL_FLAGS = FILTER_GATED | FILTER_COASTED | FILTER_REACQUIRED | FILTER_SATURATED | FILTER_WARMING_UP };

/* Formats and bounds as two_state.h states them. */
static void bounds_two_state(const two_state_t *s)
{
    FUZZ_CHECK(s->x_lsb_q16 >= -x_max_lsb_q16 && s->x_lsb_q16 <= x_max_lsb_q16, "x %ld", (long)s->x_lsb_q16);
    FUZZ_CHECK(s->rate_max_lsb_q16 <= (uint32_t)x_max_lsb_q16, "rate_max %lu", (unsigned long)s->rate_max_lsb_q16);
    FUZZ_CHECK(fx_abs32(s->rate_lsb_q16) <= s->rate_max_lsb_q16, "rate %ld above its limit %lu", (long)s->rate_lsb_q16,
               (unsigned long)s->rate_max_lsb_q16);
    FUZZ_CHECK(s->size_lsb_uq8 <= 8705u * 256u, "innovation %lu", (unsigned long)s->size_lsb_uq8);
    FUZZ_CHECK(s->r_lsb2_q8 >= TWO_STATE_R_MIN_LSB2_Q8 && s->r_lsb2_q8 <= TWO_STATE_R_MAX_LSB2_Q8, "R %lu",
               (unsigned long)s->r_lsb2_q8);
    if (!two_state_warming_up(s)) {
        FUZZ_CHECK(s->u.p.p11_uq28 < TWO_STATE_P11_END_UQ28, "P11 %lx", (unsigned long)s->u.p.p11_uq28);
        FUZZ_CHECK(s->u.p.p12_uq28 < 0x40000000u, "P12 %lx", (unsigned long)s->u.p.p12_uq28);
        FUZZ_CHECK(s->u.p.p22_uq28 < 0x30000000u, "P22 %lx", (unsigned long)s->u.p.p22_uq28);
    }
}

static void bounds_kf(const kf_t *f)
{
    bounds_two_state(&f->core);
    FUZZ_CHECK((f->core.flags & (FILTER_GATED | FILTER_REACQUIRED)) == 0, "kf has no gate: flags %u", f->core.flags);
}

static void bounds_sprf(const sprf_t *f)
{
    bounds_two_state(&f->core);
    FUZZ_CHECK(f->agree_lsb < 135u + 4609u, "agree %u", f->agree_lsb);
    FUZZ_CHECK(f->run <= 8, "run of %u samples", f->run);
}

static void own_bounds(const filter_any_t *f)
{
    switch (f->kind) {
#define BOUNDS(F)                \
    case FILTER_KIND_##F:        \
        bounds_##F(&f->state.F); \
        break;
        FILTER_LIST(BOUNDS)
#undef BOUNDS
    default:
        fuzz_fail(__FILE__, __LINE__, "kind %u", f->kind);
    }
}

static void check(const filter_any_t *f)
{
    filter_probe_t probe;
    memset(&probe, 0, sizeof probe);
    filter_any_probe(f, &probe);
    uint8_t flags = filter_any_flags(f);
    FUZZ_CHECK((flags & (uint8_t)~ALL_FLAGS) == 0 && probe.flags == flags, "flags %u, in the probe %u", flags,
               probe.flags);
    FUZZ_CHECK(probe.x_lsb_q16 >= -x_max_lsb_q16 && probe.x_lsb_q16 <= x_max_lsb_q16, "x %ld", (long)probe.x_lsb_q16);
    FUZZ_CHECK((flags & (FILTER_GATED | FILTER_COASTED)) == 0 || probe.gain_uq16 == 0, "gain %u with flags %u",
               probe.gain_uq16, flags);
    own_bounds(f);
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

static void set_parameter(filter_any_config_t *config, const filter_parameter_t *p, uint8_t place)
{
    uint32_t value = p->zero_means_off && place == 1 ? 0 : within(p->min, p->max, place);
    memcpy((uint8_t *)config + p->offset, &value, p->size); /* little endian, as the AVR */
}

/* A configuration that the filter takes; parameters that do not go together leave the defaults, which every rate has. */
static void init(filter_any_t *f, fuzz_input_t *in)
{
    filter_kind_t kind = (filter_kind_t)(fuzz_u8(in) % FILTER_KIND_COUNT);
    uint16_t rate_dhz = (uint16_t)within(50, 40000, fuzz_u8(in));
    filter_any_config_t defaults;
    memset(&defaults, 0, sizeof defaults);
    filter_any_defaults(kind, &defaults, rate_dhz);
    filter_any_config_t config = defaults;
    const filter_descriptor_t *d = filter_any_descriptor(kind);
    for (uint8_t i = 0; i < d->parameter_count; i++) {
        uint8_t place = fuzz_u8(in);
        filter_any_config_t before = config;
        set_parameter(&config, &d->parameters[i], place);
        if (!filter_any_init(f, kind, &config)) {
            config = before;
        }
    }
    FUZZ_CHECK(filter_any_init(f, kind, &config) || filter_any_init(f, kind, &defaults),
               "filter %d refuses its defaults at %u dHz", (int)kind, rate_dhz);
}

static int16_t sample(fuzz_input_t *in, uint8_t operation)
{
    static const int16_t edge[] = { INT16_MIN, -4096, -1, 0, 1, 4095, INT16_MAX, 256 };
    return operation & 0x08 ? edge[operation >> 4 & 7] : (int16_t)fuzz_u16(in);
}

/* One call; returns the estimate where the call has one. */
static int32_t call(filter_any_t *f, uint8_t operation, int16_t z, uint32_t r)
{
    switch (operation & 7) {
    case 5:
        return filter_any_coast(f);
    case 6:
        filter_any_set_noise(f, r);
        return 0;
    case 7:
        filter_any_reset(f, z);
        return 0;
    default:
        return filter_any_update(f, z);
    }
}

static void call_both(filter_any_t *f, filter_any_t *twin, fuzz_input_t *in)
{
    uint8_t operation = fuzz_u8(in);
    unsigned times = (operation & 7) == 4 || (operation & 7) == 5 ? 1u + fuzz_u8(in) : 1u;
    int16_t z = (operation & 7) == 5 || (operation & 7) == 6 ? 0 : sample(in, operation);
    uint32_t r = (operation & 7) == 6 ? fuzz_u32(in) >> (operation >> 3) : 0;
    for (; times != 0; times--) {
        int32_t x = call(f, operation, z, r);
        FUZZ_CHECK(x >= -x_max_lsb_q16 && x <= x_max_lsb_q16, "estimate %ld", (long)x);
        int32_t y = call(twin, operation, z, r);
        FUZZ_CHECK(x == y, "the copy gives %ld, the original %ld", (long)y, (long)x);
        check(f);
    }
    filter_probe_t a;
    filter_probe_t b;
    memset(&a, 0, sizeof a);
    memset(&b, 0, sizeof b);
    filter_any_probe(f, &a);
    filter_any_probe(twin, &b);
    FUZZ_CHECK(memcmp(&a, &b, sizeof a) == 0, "the copy differs from the original");
}

/* The estimate of R beside the filter, as the firmware runs it. */
static void noise_too(noise_t *n, int16_t z)
{
    bool changed = noise_update(n, z);
    uint32_t r = noise_r_lsb2_q8(n);
    FUZZ_CHECK(r >= TWO_STATE_R_MIN_LSB2_Q8 && r <= TWO_STATE_R_MAX_LSB2_Q8, "R %lu, changed %d", (unsigned long)r,
               changed);
    FUZZ_CHECK(n->mean_lsb2_q16 >= n->floor_lsb2_q16, "mean %lu below its floor", (unsigned long)n->mean_lsb2_q16);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input_t in = { data, size, 0 };
    filter_any_t f;
    memset(&f, 0, sizeof f);
    init(&f, &in);
    check(&f);
    noise_t noise;
    noise_init(&noise, (uint16_t)within(125, 8000, fuzz_u8(&in)), size % 2 != 0);
    filter_any_t twin = f;
    for (unsigned calls = 0; fuzz_more(&in); calls++) {
        if (calls % 16 == 15) {
            twin = f;
        }
        noise_too(&noise, (int16_t)(in.data[in.at] * 257));
        call_both(&f, &twin, &in);
    }
    return 0;
}
