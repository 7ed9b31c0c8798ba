/*
 * Each number that can be typed, of the settings and of every filter's parameters, at the ends of what its row of the
 * table says and just beyond; each list at its members and beside them.
 */
#include <stdio.h>
#include <stdlib.h>

#include "base/choice.h"
#include "base/number.h"
#include "filter_list.h"
#include "settings/settings.h"
#include "settings/settings_row.h"
#include "settings/settings_table.h"
#include "support/documented_limits.h"
#include "support/test.h"

enum { DECIMALS = 10000 }; /* what a number is typed in */

static uint8_t kind;

void setUp(void)
{
    kind = 0;
}

static void shipped(void)
{
    settings_defaults();
    settings_take_filter(kind);
    settings_follow();
}

/* Without the zeros at its end: so many digits may be more than are read. */
static void number_text(char text[24], int64_t ten_thousandths)
{
    const char *sign = ten_thousandths < 0 ? "-" : "";
    long long size = llabs(ten_thousandths);
    int length = snprintf(text, 24, "%s%lld.%04lld", sign, size / DECIMALS, size % DECIMALS);
    while (text[length - 1] == '0') {
        length--;
    }
    text[text[length - 1] == '.' ? length - 1 : length] = '\0';
}

/* The coarsest decimal place that tells neighbours of this format apart, or the last there is. */
static int64_t step_of(uint8_t fraction_bits)
{
    int64_t step = DECIMALS;
    while (step > 1 && step > DECIMALS >> fraction_bits) {
        step /= 10;
    }
    return step;
}

/* False where it has more digits than are read. */
static bool parse(const char *text, const setting_t *s, int32_t *value)
{
    uint32_t parsed = 0;
    bool read = number_parse(&text, s->format.fraction_bits, &parsed);
    *value = (int32_t)parsed;
    return read;
}

/* The first number from this end outwards that is beyond it (sign: -1 below, 1 above), or inwards that is not. */
static void text_at(char text[24], const setting_t *s, int sign, bool beyond)
{
    int64_t end = sign < 0 ? s->least : s->most;
    int64_t step = step_of(s->format.fraction_bits) * (beyond ? sign : -sign);
    int64_t at = (end * DECIMALS / (1 << s->format.fraction_bits) / step - 2) * step;
    int32_t value;
    do {
        at += step;
        number_text(text, at);
    } while (!parse(text, s, &value) || ((value - end) * sign > 0) != beyond);
}

/* The number in one place of three, the others as they may be beside it. */
static setting_answer_t set_number(const setting_t *s, const char *number, int place)
{
    char text[80];
    uint8_t starts;
    const char *beside = s->which == SETTING_SCALE ? "256" : "0";
    shipped();
    if (s->format.kind == NUMBER) {
        return setting_set(s->which, number, &starts);
    }
    snprintf(text, sizeof text, "%s %s %s", place == 0 ? number : beside, place == 1 ? number : beside,
             place == 2 ? number : beside);
    return setting_set(s->which, text, &starts);
}

/* How many ends are refused because the other parameters of the filter, as shipped, do not go with them. */
static unsigned assert_ends(const setting_t *s, const char *about)
{
    unsigned refused = 0;
    for (int i = 0; i < (s->format.kind == VECTOR ? 2 * 3 : 2); i++) {
        char text[24];
        int sign = i % 2 ? 1 : -1;
        text_at(text, s, sign, true);
        int32_t value;
        bool off = s->zero_is_off && parse(text, s, &value) && value == 0;
        TEST_ASSERT_EQUAL_MESSAGE(off ? SETTING_TAKEN : SETTING_ILLEGAL, set_number(s, text, i / 2), about);
        text_at(text, s, sign, false);
        bool taken = set_number(s, text, i / 2) == SETTING_TAKEN;
        TEST_ASSERT_TRUE_MESSAGE(taken || s->which >= SETTING_PARAMETERS, about);
        refused += !taken;
    }
    return refused;
}

/* Refused: poles of synth and synth_plus beyond the unit circle (5), stay of pbf and shrf beside their clean (4). */
TEST(test_each_number_is_taken_to_its_ends_and_no_further)
{
    unsigned refused = 0;
    for (kind = 0; kind < (uint8_t)FILTER_KIND_COUNT; kind++) {
        shipped();
        for (uint8_t which = 0; which < settings_count(); which++) {
            setting_t s;
            char about[80];
            shipped();
            setting_look(&s, which);
            snprintf(about, sizeof about, "%s of %s", setting_name(which), filter_listed_name((filter_kind_t)kind));
            if (s.format.kind == NUMBER || s.format.kind == VECTOR) {
                refused += assert_ends(&s, about);
            }
        }
    }
    TEST_ASSERT_EQUAL_UINT(9, refused);
}

static bool is_member(const setting_t *s, uint32_t value)
{
    bool found = false;
    for (uint8_t i = 0; i < s->most; i++) {
        found = found || setting_choice(s, i) == value;
    }
    return found;
}

/* The first parameter of each filter, one more than shipped: every other filter begins as shipped. */
TEST(test_parameters_of_the_user_are_those_of_the_chosen_filter_alone)
{
    static filter_t as_begun, as_shipped; /* all bytes 0 */
    for (uint8_t chosen = 0; chosen < (uint8_t)FILTER_KIND_COUNT; chosen++) {
        filter_config_t config = filter_defaults(filter_listed((filter_kind_t)chosen), 1000);
        filter_choice_t choice = { .parameters = { (uint32_t)config.value[0] + 1u }, .own = 1u, .filter = chosen };
        for (kind = 0; kind < (uint8_t)FILTER_KIND_COUNT; kind++) {
            config = filter_defaults(filter_listed((filter_kind_t)kind), 1000);
            if (kind == chosen) {
                config.value[0]++;
            }
            choice_begin(&choice, &as_begun, (filter_kind_t)kind, 1000);
            TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED,
                                    filter_init(&as_shipped, filter_listed((filter_kind_t)kind), &config));
            TEST_ASSERT_EQUAL_MEMORY(&as_shipped, &as_begun, sizeof as_begun);
        }
    }
}

/* R alone, all but R, and all; at whichever place the filter has it. */
TEST(test_the_users_r_is_found_among_the_parameters)
{
    enum { R = 777 };
    for (kind = 0; kind < (uint8_t)FILTER_KIND_COUNT; kind++) {
        filter_choice_t choice = { .filter = kind };
        const char *name = filter_listed_name((filter_kind_t)kind);
        uint8_t all = (uint8_t)((1u << filter_parameter_count(choice_law(&choice))) - 1u);
        uint8_t r = 0;
        for (uint8_t which = 0; which < CHOICE_PARAMETERS_MAX; which++) {
            bool is_r = (all & 1u << which) != 0 && filter_parameter(choice_law(&choice), which) == &filter_parameter_r;
            choice.parameters[which] = is_r ? R : which + 1u;
            r |= (uint8_t)(is_r << which);
        }
        choice.own = all;
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(r != 0 ? R : 0, choice_r_lsb2_q8(&choice), name);
        choice.own = r;
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(r != 0 ? R : 0, choice_r_lsb2_q8(&choice), name);
        choice.own = (uint8_t)(all & ~r);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, choice_r_lsb2_q8(&choice), name);
    }
}

TEST(test_each_list_takes_its_members_alone)
{
    static const uint8_t lists[] = { SETTING_RATE, SETTING_RANGE, SETTING_BAUD };
    for (size_t k = 0; k < 3; k++) {
        setting_t s;
        setting_look(&s, lists[k]);
        for (int i = 0; i < 3 * s.most; i++) {
            uint32_t value = setting_choice(&s, (uint8_t)(i / 3)) + (uint32_t)(i % 3) - 1u;
            char text[24];
            uint8_t starts;
            number_text(text, (int64_t)value * (lists[k] == SETTING_RATE ? DECIMALS / 10 : DECIMALS));
            shipped();
            TEST_ASSERT_EQUAL_MESSAGE(is_member(&s, value) ? SETTING_TAKEN : SETTING_ILLEGAL,
                                      setting_set(lists[k], text, &starts), text);
        }
    }
}

TEST(test_pages_have_the_ranges_of_the_table)
{
    setting_t s;
    setting_look(&s, SETTING_EVERY);
    TEST_ASSERT_EQUAL_INT32(LIMIT_EVERY_MAX, s.most);
    setting_look(&s, SETTING_OFFSET);
    TEST_ASSERT_EQUAL_INT32(-(LIMIT_OFFSET_MAX_LSB << s.format.fraction_bits), s.least);
    TEST_ASSERT_EQUAL_INT32(LIMIT_OFFSET_MAX_LSB << s.format.fraction_bits, s.most);
    setting_look(&s, SETTING_SCALE);
    TEST_ASSERT_EQUAL_INT32(LIMIT_SCALE_MIN_LSB << s.format.fraction_bits, s.least);
    TEST_ASSERT_EQUAL_INT32(LIMIT_SCALE_MAX_LSB << s.format.fraction_bits, s.most);
}
