/* See settings_table.h. Values are stored as settings.h and filter.h say. */
#include "settings_table.h"

#include <stddef.h>
#include <string.h>

#include "filter_list.h"
#include "fx.h"
#include "number.h"
#include "parameters.h"
#include "settings.h"
#include "text.h"

enum { AXES = 3 };

/* One of a list, as words or as numbers; numbers in a range, one or three; or axes. */
enum { WORDS, LIST, NUMBER, VECTOR, SIGNED_AXES };

/* As a filter's parameter has them; of a list `min` says where it begins in `choices`, and `max` how long it is. */
typedef struct {
    filter_parameter_t facts;
    uint8_t place; /* in settings_t */
    uint8_t size;  /* of a number there, bytes: 1, 2 with sign, or 4 */
    uint8_t kind;
    uint8_t starts;
} row_t;

/* Values of the lists: filters, modes, addresses, rates in 0.1 Hz, ranges, and baud rates in hundreds. */
#define KIND(F) FILTER_KIND_##F,
static const uint16_t choices[] FLASH = { FILTER_LIST(KIND) MODE_CSV, MODE_PLOT, 0, 0x53, 0x1D, 125, 250, 500, 1000,
                                          2000, 4000, 8000, 2, 4, 8, 16, 96, 192, 384, 576, 1152, 2500, 5000, 10000 };
enum {
    MODE = FILTER_KIND_COUNT,
    ADDRESS = MODE + 2,
    RATE = ADDRESS + 3,
    RANGE = RATE + 7,
    BAUD = RANGE + 4,
    BAUD_UNIT = 100,
    LISTED = sizeof choices / sizeof choices[0]
};

/* As typed, but for capitals. */
static const char words[][5] FLASH = { "csv", "plot", "auto", "53", "1D" };

#define OF(member) offsetof(settings_t, member)
enum { LEVEL_MAX_Q14 = 18841 }; /* 1.15 g; calibration_check has the last word on how long a level is */

static const row_t rows[SETTING_PARAMETERS] FLASH = {
    { { "filter", "", 0, 0, 0, FILTER_KIND_COUNT, 0 }, OF(filter), 1, WORDS, STARTS_FILTER },
    { { "rate", "Hz", 6, 0, RATE, RANGE - RATE, 0 }, OF(rate_dhz), 2, LIST, STARTS_SENSOR },
    { { "range", "g", 0, 0, RANGE, BAUD - RANGE, 0 }, OF(range_g), 1, LIST, STARTS_SENSOR },
    { { "every", "", 0, 0, 1, SETTINGS_EVERY_MAX, 0 }, OF(every), 2, NUMBER, 0 },
    { { "baud", "", 0, 0, BAUD, LISTED - BAUD, 0 }, OF(baud), 4, LIST, STARTS_LINE },
    { { "mode", "", 0, 0, MODE, ADDRESS - MODE, 0 }, OF(mode), 1, WORDS, 0 },
    { { "address", "", 0, 0, ADDRESS, RATE - ADDRESS, 0 }, OF(address), 1, WORDS, STARTS_SENSOR },
    { { "axes", "", 0, 0, 0, 0, 0 }, OF(calibration.axes), 1, SIGNED_AXES, STARTS_CALIBRATION },
    { { "offset", "LSB", 4, 0, -CALIBRATION_OFFSET_MAX_LSB_Q4, CALIBRATION_OFFSET_MAX_LSB_Q4, 0 },
      OF(calibration.offset_lsb_q4),
      2,
      VECTOR,
      STARTS_CALIBRATION },
    { { "scale", "LSB/g", 6, 0, CALIBRATION_SCALE_MIN_UQ6, CALIBRATION_SCALE_MAX_UQ6, 0 },
      OF(calibration.scale_lsb_per_g_uq6),
      2,
      VECTOR,
      STARTS_CALIBRATION },
    { { "level", "", 14, 0, -LEVEL_MAX_Q14, LEVEL_MAX_Q14, 0 },
      OF(calibration.level_q14),
      2,
      VECTOR,
      STARTS_CALIBRATION },
};

_Static_assert((int)FILTER_PARAMETERS_MAX <= (int)SETTINGS_PARAMETERS_MAX, "the settings hold a filter's parameters");
_Static_assert(CALIBRATION_SCALE_MAX_UQ6 <= INT16_MAX, "two bytes are read with sign");
_Static_assert(OF(calibration) + sizeof(calibration_t) <= UINT8_MAX, "a place has a byte");

/* A setting that is looked at: its row, or the descriptor of the filter's parameter. */
typedef struct {
    const filter_parameter_t *facts; /* in program memory */
    uint8_t which;
    uint8_t place;
    uint8_t size;
    uint8_t kind;
    uint8_t starts;
} setting_t;

settings_cycles_t settings_cycles;

static const filter_law_t *law_in_force(void)
{
    return filter_listed((filter_kind_t)settings.filter);
}

FX_NOINLINE void look(setting_t *s, uint8_t which)
{
    s->which = which;
    if (which < SETTING_PARAMETERS) {
        const row_t *row = &rows[which];
        s->facts = &row->facts;
        s->place = flash_u8(&row->place);
        s->size = flash_u8(&row->size);
        s->kind = flash_u8(&row->kind);
        s->starts = flash_u8(&row->starts);
    } else {
        which = (uint8_t)(which - SETTING_PARAMETERS);
        s->facts = filter_parameter(law_in_force(), which);
        s->place = (uint8_t)(OF(parameters) + which * sizeof settings.parameters[0]);
        s->size = sizeof settings.parameters[0];
        s->kind = NUMBER;
        s->starts = STARTS_FILTER;
    }
}

static uint8_t fraction_bits(const setting_t *s)
{
    return flash_u8(&s->facts->fraction_bits);
}

/* Of a list, where it begins and how long it is. */
static uint8_t first(const setting_t *s)
{
    return (uint8_t)flash_u32((const uint32_t *)&s->facts->min);
}

static uint8_t length(const setting_t *s)
{
    return (uint8_t)flash_u32((const uint32_t *)&s->facts->max);
}

uint8_t settings_count(void)
{
    return (uint8_t)(SETTING_PARAMETERS + filter_parameter_count(law_in_force()));
}

flash_text_t setting_name(uint8_t which)
{
    setting_t s;
    look(&s, which);
    return s.facts->name;
}

uint8_t setting_named(const char *name)
{
    uint8_t which = settings_count();
    do {
        if (which == 0) {
            return SETTING_NONE;
        }
        which--;
    } while (!text_equal(name, setting_name(which)));
    return which;
}

FX_NOINLINE uint8_t numbers(const setting_t *s)
{
    return s->kind == VECTOR ? AXES : 1;
}

FX_NOINLINE uint8_t *place_of(const setting_t *s, uint8_t number)
{
    return (uint8_t *)&settings + s->place + (uint8_t)(number * s->size);
}

FX_NOINLINE uint32_t value_of(const setting_t *s, uint8_t number)
{
    if (s->which >= SETTING_PARAMETERS) {
        return parameters_value((uint8_t)(s->which - SETTING_PARAMETERS));
    }
    if (s->which == SETTING_EVERY) {
        return settings_every_in_force();
    }
    const uint8_t *at = place_of(s, number);
    switch (s->size) {
    case 1:
        return *at;
    case 2:
        return (uint32_t)(int32_t)(int16_t)((uint16_t)at[1] << 8 | at[0]);
    default:
        return settings.baud;
    }
}

/* Little-endian on PC and chip, as settings.h wants it. */
FX_NOINLINE void put(const setting_t *s, uint8_t number, uint32_t value)
{
    memcpy(place_of(s, number), &value, s->size);
}

/* Of a list, as stored. */
FX_NOINLINE uint32_t choice(const setting_t *s, uint8_t i)
{
    uint16_t value = flash_u16(&choices[first(s) + i]);
    return s->which == SETTING_BAUD ? (uint32_t)value * BAUD_UNIT : value;
}

FX_NOINLINE flash_text_t word(const setting_t *s, uint8_t i)
{
    return s->which == SETTING_FILTER ? filter_listed_name((filter_kind_t)i) : words[first(s) - MODE + i];
}

FX_NOINLINE bool take_word(const setting_t *s, const char *text)
{
    uint8_t i = length(s);
    do {
        if (i == 0) {
            return false;
        }
        i--;
    } while (!text_equal(text, word(s, i)));
    put(s, 0, choice(s, i));
    return true;
}

static bool is_legal(const setting_t *s, uint32_t value)
{
    if (s->kind != LIST) {
        return filter_in_range(s->facts, (int32_t)value);
    }
    uint8_t i = length(s);
    while (i != 0) {
        i--;
        if (choice(s, i) == value) {
            return true;
        }
    }
    return false;
}

/* A rate has 6 fraction bits, with which each legal one is exact, and is stored in tenths: with a rest it is none. */
static bool to_tenths(uint32_t *value)
{
    uint32_t tenths_q5 = *value * 5u;
    *value = tenths_q5 >> 5;
    return (tenths_q5 & 31u) == 0;
}

FX_NOINLINE bool take_numbers(const setting_t *s, const char *text)
{
    for (uint8_t i = 0; i < numbers(s); i++) {
        uint32_t value;
        if (!number_parse(&text, fraction_bits(s), &value) || (s->which == SETTING_RATE && !to_tenths(&value)) ||
            !is_legal(s, value)) {
            return false;
        }
        put(s, i, value);
    }
    return *text == '\0';
}

/* Each of x, y, z once, with a sign where it is reversed, and no mirror image: that is no way to mount a board. */
FX_NOINLINE bool take_axes(const char *text)
{
    bool mirrored = false;
    int8_t before = 0;
    for (uint8_t i = 0; i < AXES; i++) {
        bool reversed = *text == '-';
        text += reversed;
        int8_t axis = (int8_t)(*text++ - ('x' - 1));
        if (axis < 1 || axis > AXES) {
            return false;
        }
        bool backward = i == 1u && axis != before % AXES + 1;
        mirrored ^= reversed ^ backward;
        before = axis;
        settings.calibration.axes[i] = (int8_t)(reversed ? -axis : axis);
    }
    return !mirrored && *text == '\0';
}

static bool take(const setting_t *s, const char *text)
{
    switch (s->kind) {
    case WORDS:
        return take_word(s, text);
    case SIGNED_AXES:
        return take_axes(text);
    default:
        return take_numbers(s, text);
    }
}

/* All settings with the new one among them. */
FX_NOINLINE setting_answer_t judge(const setting_t *s)
{
    if (s->which == SETTING_FILTER) {
        settings_take_filter(settings.filter);
    }
    if (s->which >= SETTING_PARAMETERS) {
        settings.own = (uint8_t)(settings.own | 1u << (s->which - SETTING_PARAMETERS));
        return parameters_legal() ? SETTING_TAKEN : SETTING_ILLEGAL;
    }
    if (!settings_fit(settings.filter, settings.rate_dhz)) {
        settings_cycles.takes = settings_filter_cycles(settings.filter);
        settings_cycles.left = (uint16_t)settings_left_cycles(settings.rate_dhz); /* less than that */
        return SETTING_TOO_SLOW;
    }
    return calibration_check(&settings.calibration).why == CALIBRATION_GOOD ? SETTING_TAKEN : SETTING_ILLEGAL;
}

setting_answer_t setting_set(uint8_t which, const char *text, uint8_t *starts)
{
    settings_t before = settings;
    setting_t s;
    look(&s, which);
    setting_answer_t answer = take(&s, text) ? judge(&s) : SETTING_ILLEGAL;
    if (answer != SETTING_TAKEN) {
        settings = before;
    }
    *starts = memcmp(&before, &settings, sizeof before) != 0 ? s.starts : 0;
    return answer;
}

FX_NOINLINE void write_axes(void)
{
    for (uint8_t i = 0; i < AXES; i++) {
        int8_t axis = settings.calibration.axes[i];
        if (axis < 0) {
            text_char('-');
            axis = (int8_t)-axis;
        }
        text_char((char)('x' - 1 + axis));
    }
}

FX_NOINLINE void write_value(const setting_t *s, uint32_t value)
{
    uint8_t i = 0;
    if (s->kind == SIGNED_AXES) {
        write_axes();
    } else if (s->kind == WORDS) {
        while (choice(s, i) != value) {
            i++;
        }
        text_words(word(s, i));
    } else if (s->which == SETTING_RATE) {
        text_tenths((uint16_t)value);
    } else {
        number_write(value, fraction_bits(s));
    }
}

void setting_write(uint8_t which)
{
    setting_t s;
    look(&s, which);
    text_words(s.facts->name);
    for (uint8_t i = 0; i < numbers(&s); i++) {
        text_char(' ');
        write_value(&s, value_of(&s, i));
    }
    if (flash_char(s.facts->unit) != '\0') {
        text_char(' ');
        text_words(s.facts->unit);
    }
}

static void write_range(const setting_t *s)
{
    number_write(flash_u32((const uint32_t *)&s->facts->min), fraction_bits(s));
    text_words(FLASH_TEXT(" to "));
    number_write(flash_u32((const uint32_t *)&s->facts->max), fraction_bits(s));
    if (flash_u8(&s->facts->zero_means_off) != 0) {
        text_words(FLASH_TEXT(", 0: off"));
    }
}

void setting_write_legal(uint8_t which)
{
    setting_t s;
    look(&s, which);
    if (s.kind == SIGNED_AXES) {
        text_words(FLASH_TEXT("24 like xyz or -yxz"));
    } else if (s.kind > LIST) {
        write_range(&s);
    } else {
        for (uint8_t i = 0; i < length(&s); i++) {
            if (i != 0) {
                text_char(' ');
            }
            write_value(&s, choice(&s, i));
        }
    }
}
