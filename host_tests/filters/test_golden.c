/*
 * The filters give what they gave when their vectors were committed: a change of a bit is meant or a fault. Whether the
 * numbers are right is judged against the double references elsewhere (test_*_reference); that the chip gives the same
 * is make bitexact's.
 */
#include "support/filters.h"
#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GOLDEN "host_tests/filters/golden/filters_100hz.csv"
#define HEAD_LINES 2

static filter_t filters[FILTER_KIND_COUNT];

/* The next field of a line, and what comes behind it; an empty field is NULL. */
static char *next_field(char **rest)
{
    char *field = *rest;
    size_t length = strcspn(field, ",\n");
    *rest = field + length + (field[length] != '\0' ? 1 : 0);
    field[length] = '\0';
    return (length == 0) ? NULL : field;
}

static void begin_as_named(char *head)
{
    char name[80];
    TEST_ASSERT_EQUAL_STRING("z", next_field(&head));
    FOR_EACH_KIND(kind)
    {
        const char *column = next_field(&head);
        snprintf(name, sizeof name, GOLDEN ": column %u is not %s: run make golden", kind + 2U,
                 filter_listed_name((filter_kind_t)kind));
        TEST_ASSERT_NOT_NULL_MESSAGE(column, name);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(filter_listed_name((filter_kind_t)kind), column, name);
        TEST_ASSERT_TRUE(init_default(&filters[kind], (filter_kind_t)kind, 1000));
    }
    TEST_ASSERT_EQUAL_STRING("", head);
}

static void step_as_told(char *line, unsigned number)
{
    char place[140];
    const char *z = next_field(&line);
    FOR_EACH_KIND(kind)
    {
        const char *wanted = next_field(&line);
        snprintf(place, sizeof place, GOLDEN ":%u: %s; if you mean the change: make golden", number,
                 filter_listed_name((filter_kind_t)kind));
        TEST_ASSERT_NOT_NULL_MESSAGE(wanted, place);
        int32_t x = (z == NULL) ? coast_only(&filters[kind])
                                : filter_update(&filters[kind], (int16_t)strtol(z, NULL, 10));
        TEST_ASSERT_EQUAL_INT32_MESSAGE((int32_t)strtol(wanted, NULL, 10), x, place);
    }
}

TEST(every_filter_gives_its_golden_vector)
{
    FILE *file = fopen(GOLDEN, "r");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, GOLDEN ": cannot be opened");
    char line[512];
    unsigned number = 0;
    while (fgets(line, sizeof line, file) != NULL) {
        number++;
        if (number == HEAD_LINES) {
            begin_as_named(line);
        } else if (number > HEAD_LINES) {
            step_as_told(line, number);
        }
    }
    fclose(file);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(400 + HEAD_LINES, number, GOLDEN ": rows are missing");
}
