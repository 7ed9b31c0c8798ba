/*
 * The dispatch over the list of filters: each call reaches the filter of its kind, and none for a kind that there is
 * not.
 */
#include <string.h>

#include "filter_any.h"
#include "unity.h"

void setUp(void) {}

void tearDown(void) {}

static void test_an_unknown_kind_changes_nothing(void)
{
    filter_any_t f;
    filter_any_config_t config;
    filter_probe_t probe;
    memset(&f, 0xA5, sizeof f);
    memset(&config, 0x5A, sizeof config);
    memset(&probe, 0xC3, sizeof probe);
    f.kind = FILTER_KIND_COUNT;
    filter_any_t f_before = f;
    filter_any_config_t config_before = config;
    filter_probe_t probe_before = probe;
    TEST_ASSERT_NULL(filter_any_descriptor(FILTER_KIND_COUNT));
    filter_any_defaults(FILTER_KIND_COUNT, &config, 1000);
    TEST_ASSERT_EQUAL_MEMORY(&config_before, &config, sizeof config);
    TEST_ASSERT_FALSE(filter_any_init(&f, FILTER_KIND_COUNT, &config));
    filter_any_set_noise(&f, 256);
    filter_any_reset(&f, 100);
    TEST_ASSERT_EQUAL_INT32(0, filter_any_update(&f, 100));
    TEST_ASSERT_EQUAL_INT32(0, filter_any_coast(&f));
    TEST_ASSERT_EQUAL_UINT8(0, filter_any_flags(&f));
    TEST_ASSERT_EQUAL_MEMORY(&f_before, &f, sizeof f);
    filter_any_probe(&f, &probe);
    TEST_ASSERT_EQUAL_MEMORY(&probe_before, &probe, sizeof probe);
}

static void test_name_and_descriptor_agree(void)
{
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        const filter_descriptor_t *d = filter_any_descriptor((filter_kind_t)kind);
        TEST_ASSERT_NOT_NULL(d);
        TEST_ASSERT_EQUAL_STRING(d->name, filter_any_name((filter_kind_t)kind));
        TEST_ASSERT_EQUAL_INT(kind, filter_any_find(d->name));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_unknown_kind_changes_nothing);
    RUN_TEST(test_name_and_descriptor_agree);
    return UNITY_END();
}
