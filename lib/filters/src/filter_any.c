/*
 * Dispatch over the list of filters by switch: direct calls, which the compiler may inline and a stack analysis can
 * follow.
 */
#include "filter_any.h"

const filter_descriptor_t *filter_any_descriptor(filter_kind_t kind)
{
    switch (kind) {
#define DESCRIPTOR(F)     \
    case FILTER_KIND_##F: \
        return &F##_descriptor;
        FILTER_LIST(DESCRIPTOR)
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

const char *filter_any_name(filter_kind_t kind)
{
    return names[kind];
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
#define DEFAULTS(F)                         \
    case FILTER_KIND_##F:                   \
        F##_defaults(&config->F, rate_dhz); \
        break;
        FILTER_LIST(DEFAULTS)
#undef DEFAULTS
    default:
        break;
    }
}

bool filter_any_init(filter_any_t *f, filter_kind_t kind, const filter_any_config_t *config)
{
    switch (kind) {
#define INIT(F)                                   \
    case FILTER_KIND_##F:                         \
        if (!F##_init(&f->state.F, &config->F)) { \
            return false;                         \
        }                                         \
        break;
        FILTER_LIST(INIT)
#undef INIT
    default:
        return false;
    }
    f->kind = (uint8_t)kind;
    return true;
}

void filter_any_set_noise(filter_any_t *f, uint32_t r_lsb2_q8)
{
    switch (f->kind) {
#define SET_NOISE(F)                           \
    case FILTER_KIND_##F:                      \
        F##_set_noise(&f->state.F, r_lsb2_q8); \
        break;
        FILTER_LIST(SET_NOISE)
#undef SET_NOISE
    default:
        break;
    }
}

void filter_any_reset(filter_any_t *f, int16_t z0_lsb)
{
    switch (f->kind) {
#define RESET(F)                        \
    case FILTER_KIND_##F:               \
        F##_reset(&f->state.F, z0_lsb); \
        break;
        FILTER_LIST(RESET)
#undef RESET
    default:
        break;
    }
}

int32_t filter_any_update(filter_any_t *f, int16_t z_lsb)
{
    switch (f->kind) {
#define UPDATE(F)         \
    case FILTER_KIND_##F: \
        return F##_update(&f->state.F, z_lsb);
        FILTER_LIST(UPDATE)
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
        return F##_coast(&f->state.F);
        FILTER_LIST(COAST)
#undef COAST
    default:
        return 0;
    }
}

uint8_t filter_any_flags(const filter_any_t *f)
{
    switch (f->kind) {
#define FLAGS(F)          \
    case FILTER_KIND_##F: \
        return F##_flags(&f->state.F);
        FILTER_LIST(FLAGS)
#undef FLAGS
    default:
        return 0;
    }
}

void filter_any_probe(const filter_any_t *f, filter_probe_t *out)
{
    switch (f->kind) {
#define PROBE(F)                     \
    case FILTER_KIND_##F:            \
        F##_probe(&f->state.F, out); \
        break;
        FILTER_LIST(PROBE)
#undef PROBE
    default:
        break;
    }
}
