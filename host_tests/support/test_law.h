/* What the tests of single laws begin with and do again and again, on the PC and on the chip. */
#ifndef SUPPORT_TEST_LAW_H
#define SUPPORT_TEST_LAW_H

#include "support/laws.h"
#include "support/test.h"

/* A filter with a configuration that its law accepts. */
static inline filter_t made(const filter_law_t *law, const filter_config_t *config)
{
    filter_t f;
    TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(&f, law, config));
    return f;
}

/* A filter with its law's defaults. */
static inline filter_t made_default(const filter_law_t *law, uint16_t rate_dhz)
{
    filter_config_t config = filter_defaults(law, rate_dhz);
    return made(law, &config);
}

static inline filter_t made_kind(uint8_t kind, uint16_t rate_dhz)
{
    return made_default(filter_listed((filter_kind_t)kind), rate_dhz);
}

/* So many equal samples. */
static inline void feed(filter_t *f, int16_t z_lsb, uint16_t samples)
{
    for (uint16_t k = 0; k < samples; k++) {
        (void)filter_update(f, z_lsb);
    }
}

static inline filter_probe_t probe_of(const filter_t *f)
{
    filter_probe_t probe;
    filter_probe(f, &probe);
    return probe;
}

#endif
