/*
 * Dispatch over the list of filters by switch: direct calls, which the compiler may inline and a stack analysis can
 * follow.
 */
#include "filter_any.h"

#include "filter_parameter.h"

const filter_descriptor_t *filter_any_descriptor(filter_kind_t kind)
{
    switch (kind) {
#define DESCRIPTOR(F)     \
    case FILTER_KIND_##F: \
        return &F##_descriptor;
        FILTER_LINKED(DESCRIPTOR)
#undef DESCRIPTOR
    default:
        return NULL;
    }
}

/* Apart from the descriptors, so that firmware without parameter commands need not hold these. */
static const char names[FILTER_KIND_COUNT][12] FX_FLASH = {
#define NAME(F) #F,
    FILTER_LIST(NAME)
#undef NAME
};

FX_ONCE const char *filter_any_name(filter_kind_t kind)
{
    return names[kind];
}

static const uint16_t worst_cycles[FILTER_KIND_COUNT] FX_FLASH = {
#define WORST_CYCLES(F) F##_worst_cycles,
    FILTER_LIST(WORST_CYCLES)
#undef WORST_CYCLES
};

uint16_t filter_any_worst_cycles(filter_kind_t kind)
{
    return fx_flash_u16(&worst_cycles[kind]);
}

/* Text in RAM equal to text in program memory. */
static bool same_text(const char *ram, const char *flash)
{
    for (;; ram++, flash++) {
        char c = (char)fx_flash_u8((const uint8_t *)flash);
        if (*ram != c) {
            return false;
        }
        if (c == '\0') {
            return true;
        }
    }
}

filter_kind_t filter_any_find(const char *name)
{
    for (uint8_t kind = 0; kind < (uint8_t)FILTER_KIND_COUNT; kind++) {
        if (same_text(name, names[kind])) {
            return (filter_kind_t)kind;
        }
    }
    return FILTER_KIND_COUNT;
}

void filter_any_defaults(filter_kind_t kind, filter_any_config_t *config, uint16_t rate_dhz)
{
    switch (kind) {
#define DEFAULTS(F)                              \
    case FILTER_KIND_##F:                        \
        F##_defaults(&config->of_##F, rate_dhz); \
        break;
        FILTER_LINKED(DEFAULTS)
#undef DEFAULTS
    default:
        break;
    }
}

bool filter_any_init(filter_any_t *f, filter_kind_t kind, const filter_any_config_t *config)
{
    switch (kind) {
#define INIT(F)                                             \
    case FILTER_KIND_##F:                                   \
        if (!F##_init(&f->state.of_##F, &config->of_##F)) { \
            return false;                                   \
        }                                                   \
        break;
        FILTER_LINKED(INIT)
#undef INIT
    default:
        return false;
    }
    f->kind = (uint8_t)kind;
    return true;
}

bool filter_any_together(filter_kind_t kind, const filter_any_config_t *config)
{
    switch (kind) {
#define TOGETHER(F)       \
    case FILTER_KIND_##F: \
        return F##_together(&config->of_##F);
        FILTER_LINKED(TOGETHER)
#undef TOGETHER
    default:
        return false;
    }
}

FX_ONCE void filter_any_configure(filter_any_t *f, filter_kind_t kind, const filter_any_config_t *config)
{
    switch (kind) {
#define CONFIGURE(F)                                      \
    case FILTER_KIND_##F:                                 \
        F##_configure(&f->state.of_##F, &config->of_##F); \
        break;
        FILTER_LINKED(CONFIGURE)
#undef CONFIGURE
    default:
        return;
    }
    f->kind = (uint8_t)kind;
}

void filter_any_set_noise(filter_any_t *f, uint32_t r_lsb2_q8)
{
    switch (f->kind) {
#define SET_NOISE(F)                                \
    case FILTER_KIND_##F:                           \
        F##_set_noise(&f->state.of_##F, r_lsb2_q8); \
        break;
        FILTER_LINKED(SET_NOISE)
#undef SET_NOISE
    default:
        break;
    }
}

void filter_any_reset(filter_any_t *f, int16_t z0_lsb)
{
    switch (f->kind) {
#define RESET(F)                             \
    case FILTER_KIND_##F:                    \
        F##_reset(&f->state.of_##F, z0_lsb); \
        break;
        FILTER_LINKED(RESET)
#undef RESET
    default:
        break;
    }
}

bool filter_any_reset_step(filter_any_t *f, int16_t z0_lsb, uint8_t step)
{
    switch (f->kind) {
#define RESET_STEP(F)     \
    case FILTER_KIND_##F: \
        return F##_reset_step(&f->state.of_##F, z0_lsb, step);
        FILTER_LINKED(RESET_STEP)
#undef RESET_STEP
    default:
        return false;
    }
}

int32_t filter_any_update(filter_any_t *f, int16_t z_lsb)
{
    switch (f->kind) {
#define UPDATE(F)         \
    case FILTER_KIND_##F: \
        return F##_update(&f->state.of_##F, z_lsb);
        FILTER_LINKED(UPDATE)
#undef UPDATE
    default:
        return 0;
    }
}

int32_t filter_any_coast(filter_any_t *f)
{
    switch (f->kind) {
#define COAST(F)          \
    case FILTER_KIND_##F: \
        return F##_coast(&f->state.of_##F);
        FILTER_LINKED(COAST)
#undef COAST
    default:
        return 0;
    }
}

void filter_any_gap(filter_any_t *f)
{
    switch (f->kind) {
#define GAP(F)                     \
    case FILTER_KIND_##F:          \
        F##_gap(&f->state.of_##F); \
        break;
        FILTER_LINKED(GAP)
#undef GAP
    default:
        break;
    }
}

void filter_any_damp(filter_any_t *f)
{
    switch (f->kind) {
#define DAMP(F)                     \
    case FILTER_KIND_##F:           \
        F##_damp(&f->state.of_##F); \
        break;
        FILTER_LINKED(DAMP)
#undef DAMP
    default:
        break;
    }
}

void filter_any_hold(filter_any_t *f)
{
    switch (f->kind) {
#define HOLD(F)                     \
    case FILTER_KIND_##F:           \
        F##_hold(&f->state.of_##F); \
        break;
        FILTER_LINKED(HOLD)
#undef HOLD
    default:
        break;
    }
}

void filter_any_restart(filter_any_t *f)
{
    switch (f->kind) {
#define RESTART(F)                     \
    case FILTER_KIND_##F:              \
        F##_restart(&f->state.of_##F); \
        break;
        FILTER_LINKED(RESTART)
#undef RESTART
    default:
        break;
    }
}

FX_ONCE uint8_t filter_any_flags(const filter_any_t *f)
{
    switch (f->kind) {
#define FLAGS(F)          \
    case FILTER_KIND_##F: \
        return F##_flags(&f->state.of_##F);
        FILTER_LINKED(FLAGS)
#undef FLAGS
    default:
        return 0;
    }
}

void filter_any_probe(const filter_any_t *f, filter_probe_t *out)
{
    switch (f->kind) {
#define PROBE(F)                          \
    case FILTER_KIND_##F:                 \
        F##_probe(&f->state.of_##F, out); \
        break;
        FILTER_LINKED(PROBE)
#undef PROBE
    default:
        break;
    }
}

uint8_t filter_any_refused(filter_kind_t kind, const filter_any_config_t *config)
{
    const filter_descriptor_t *descriptor = filter_any_descriptor(kind);
    if (descriptor == NULL) {
        return FILTER_REFUSED_KIND;
    }
    uint16_t rate_dhz = config->rate_dhz;
    if (rate_dhz < FILTER_RATE_MIN_DHZ || rate_dhz > FILTER_RATE_MAX_DHZ) {
        return FILTER_REFUSED_RATE;
    }
    const filter_parameter_t *parameters = (const filter_parameter_t *)fx_flash_pointer(&descriptor->parameters);
    uint8_t count = fx_flash_u8(&descriptor->parameter_count);
    for (uint8_t i = 0; i < count; i++) {
        if (!filter_parameter_in_range(&parameters[i], filter_parameter_get(config, &parameters[i]))) {
            return i;
        }
    }
    return FILTER_REFUSED_TOGETHER;
}
