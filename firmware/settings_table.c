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

enum { OFFSET_MAX = CALIBRATION_OFFSET_MAX_LSB_Q4, LEVEL_MAX_Q14 = 18841 }; /* 1.15 g */

/*
 * Name, unit, place in settings_t, bytes of a number there, kind, fraction bits, what a change starts, and the range; of
 * a list where it begins in `choices` and how long it is. calibration_check has the last word on vectors.
 */
/* clang-format off */
#define SETTINGS(X) \
    X("filter", "", filter, 1, WORDS, 0, STARTS_FILTER, 0, FILTER_KIND_COUNT) \
    X("rate", "Hz", rate_dhz, 2, LIST, 6, STARTS_SENSOR, RATE, RANGE - RATE) \
    X("range", "g", range_g, 1, LIST, 0, STARTS_SENSOR, RANGE, BAUD - RANGE) \
    X("every", "", every, 2, NUMBER, 0, 0, 1, SETTINGS_EVERY_MAX) \
    X("baud", "", baud, 4, LIST, 0, STARTS_LINE, BAUD, LISTED - BAUD) \
    X("mode", "", mode, 1, WORDS, 0, 0, MODE, ADDRESS - MODE) \
    X("address", "", address, 1, WORDS, 0, STARTS_SENSOR, ADDRESS, RATE - ADDRESS) \
    X("axes", "", calibration.axes, 1, SIGNED_AXES, 0, STARTS_CALIBRATION, 0, 0) \
    X("offset", "LSB", calibration.offset_lsb_q4, 2, VECTOR, 4, STARTS_CALIBRATION, -OFFSET_MAX, OFFSET_MAX) \
    X("scale", "LSB/g", calibration.scale_lsb_per_g_uq6, 2, VECTOR, 6, STARTS_CALIBRATION, CALIBRATION_SCALE_MIN_UQ6, \
      CALIBRATION_SCALE_MAX_UQ6) \
    X("level", "", calibration.level_q14, 2, VECTOR, 14, STARTS_CALIBRATION, -LEVEL_MAX_Q14, LEVEL_MAX_Q14)
/* clang-format on */

typedef struct {
    uint8_t place;
    uint8_t size;
    uint8_t kind;
    uint8_t fraction_bits;
    uint8_t starts;
} format_t;

typedef struct {
    format_t format;
    int16_t least, most;
} row_t;

#define NAME(name, ...) name "\0"
#define UNIT(name, unit, ...) unit "\0"
#define ROW(name, unit, member, size, kind, bits, starts, least, most) \
    { { offsetof(settings_t, member), size, kind, bits, starts }, least, most },
static const char names[] FLASH = SETTINGS(NAME);
static const char units[] FLASH = SETTINGS(UNIT);
static const row_t rows[] FLASH = { SETTINGS(ROW) };

_Static_assert(sizeof rows / sizeof rows[0] == SETTING_PARAMETERS, "a row for each setting");
_Static_assert((int)FILTER_PARAMETERS_MAX <= (int)SETTINGS_PARAMETERS_MAX, "the settings hold a filter's parameters");
_Static_assert(CALIBRATION_SCALE_MAX_UQ6 <= INT16_MAX, "two bytes are read with sign");
_Static_assert(offsetof(settings_t, calibration) + sizeof(calibration_t) <= UINT8_MAX, "a place has a byte");

/* A setting that is looked at: its row, or the descriptor of the filter's parameter. */
typedef struct {
    format_t format;
    uint8_t which;
    bool zero_is_off;
    int32_t least, most;
} setting_t;

static const filter_law_t *law_in_force(void)
{
    return filter_listed((filter_kind_t)settings.filter);
}

static void look_at_row(setting_t *s, uint8_t which)
{
    const row_t *row = &rows[which];
    const uint8_t *from = (const uint8_t *)row;
    uint8_t *to = (uint8_t *)&s->format;
    for (uint8_t i = 0; i < sizeof s->format; i++) {
        to[i] = flash_u8(from + i);
    }
    s->least = (int16_t)flash_u16((const uint16_t *)&row->least);
    s->most = (int16_t)flash_u16((const uint16_t *)&row->most);
    s->zero_is_off = false;
}

/* The descriptor of a setting that is the filter's, in program memory. */
static const filter_parameter_t *parameter_of(uint8_t which)
{
    return filter_parameter(law_in_force(), (uint8_t)(which - SETTING_PARAMETERS));
}

static void look_at_parameter(setting_t *s, uint8_t which)
{
    const filter_parameter_t *parameter = parameter_of(which);
    uint8_t place = (uint8_t)(offsetof(settings_t, parameters) +
                              (uint8_t)(which - SETTING_PARAMETERS) * sizeof settings.parameters[0]);
    s->format = (format_t){ place, sizeof settings.parameters[0], NUMBER, flash_u8(&parameter->fraction_bits),
                            STARTS_FILTER };
    s->least = (int32_t)flash_u32((const uint32_t *)&parameter->min);
    s->most = (int32_t)flash_u32((const uint32_t *)&parameter->max);
    s->zero_is_off = flash_u8(&parameter->zero_means_off) != 0;
}

static void look(setting_t *s, uint8_t which)
{
    s->which = which;
    if (which < SETTING_PARAMETERS) {
        look_at_row(s, which);
    } else {
        look_at_parameter(s, which);
    }
}

uint8_t settings_count(void)
{
    return (uint8_t)(SETTING_PARAMETERS + filter_parameter_count(law_in_force()));
}

flash_text_t setting_name(uint8_t which)
{
    return which < SETTING_PARAMETERS ? text_nth(names, which) : parameter_of(which)->name;
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

static uint8_t numbers(const setting_t *s)
{
    return s->format.kind == VECTOR ? AXES : 1;
}

static uint8_t *place_of(const setting_t *s, uint8_t number)
{
    return (uint8_t *)&settings + s->format.place + (uint8_t)(number * s->format.size);
}

/* Little-endian on PC and chip, as settings.h wants it; all numbers have a sign. */
static uint32_t value_of(const setting_t *s, uint8_t number)
{
    if (s->which >= SETTING_PARAMETERS) {
        return parameters_value((uint8_t)(s->which - SETTING_PARAMETERS));
    }
    if (s->which == SETTING_EVERY) {
        return settings_every_in_force();
    }
    const uint8_t *at = place_of(s, number) + s->format.size;
    uint32_t value = (uint32_t)(int32_t)(int8_t)*--at;
    for (uint8_t left = s->format.size; --left != 0;) {
        value = value << 8 | *--at;
    }
    return value;
}

FX_NOINLINE void put(const setting_t *s, uint8_t number, uint32_t value)
{
    uint8_t *at = place_of(s, number);
    for (uint8_t left = s->format.size; left != 0; left--) {
        *at++ = (uint8_t)value;
        value >>= 8;
    }
}

/* Of a list, as stored. */
static uint32_t choice(const setting_t *s, uint8_t i)
{
    uint16_t value = flash_u16(&choices[s->least + i]);
    return s->which == SETTING_BAUD ? (uint32_t)value * BAUD_UNIT : value;
}

FX_NOINLINE flash_text_t word(const setting_t *s, uint8_t i)
{
    return s->which == SETTING_FILTER ? filter_listed_name((filter_kind_t)i) : words[s->least - MODE + i];
}

static bool take_word(const setting_t *s, const char *text)
{
    uint8_t i = (uint8_t)s->most;
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
    if (s->format.kind != LIST) {
        return ((int32_t)value >= s->least && (int32_t)value <= s->most) || (value == 0 && s->zero_is_off);
    }
    uint8_t i = (uint8_t)s->most;
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
        if (!number_parse(&text, s->format.fraction_bits, &value) || (s->which == SETTING_RATE && !to_tenths(&value)) ||
            !is_legal(s, value)) {
            return false;
        }
        put(s, i, value);
    }
    return *text == '\0';
}

/* Each of x, y, z once, with a sign where it is reversed, and no mirror image: that is no way to mount a board. */
static bool take_axes(const char *text)
{
    enum { XYZ = 0x123, YZX = 0x231, ZXY = 0x312 };
    uint16_t order = 0;
    bool mirrored = true;
    for (uint8_t i = 0; i < AXES; i++) {
        bool reversed = *text == '-';
        text += reversed;
        int8_t axis = (int8_t)(*text++ - ('x' - 1));
        if (axis < 1 || axis > AXES) {
            return false;
        }
        order = (uint16_t)(order << 4 | (uint8_t)axis);
        mirrored ^= reversed;
        settings.calibration.axes[i] = (int8_t)(reversed ? -axis : axis);
    }
    bool turned = order == XYZ || order == YZX || order == ZXY;
    return turned == mirrored && *text == '\0';
}

static bool take(const setting_t *s, const char *text)
{
    switch (s->format.kind) {
    case WORDS:
        return take_word(s, text);
    case SIGNED_AXES:
        return take_axes(text);
    default:
        return take_numbers(s, text);
    }
}

/* Whether the filter takes the user's parameters with this one among them. */
static setting_answer_t judge_parameter(uint8_t which)
{
    uint8_t own = settings.own;
    settings.own = (uint8_t)(own | 1u << which);
    if (parameters_legal()) {
        return SETTING_TAKEN;
    }
    settings.own = own;
    return SETTING_ILLEGAL;
}

/* All settings with the new one among them. */
static setting_answer_t judge(const setting_t *s)
{
    if (s->which >= SETTING_PARAMETERS) {
        return judge_parameter((uint8_t)(s->which - SETTING_PARAMETERS));
    }
    if (!settings_fit(settings.filter, settings.rate_dhz)) {
        return SETTING_TOO_SLOW;
    }
    if (s->which == SETTING_FILTER) {
        settings_take_filter(settings.filter);
    }
    return calibration_check(&settings.calibration).why == CALIBRATION_GOOD ? SETTING_TAKEN : SETTING_ILLEGAL;
}

/* A filter that is in force already starts with what is shipped again. */
setting_answer_t setting_set(uint8_t which, const char *text, uint8_t *starts)
{
    uint8_t before[AXES * sizeof(int16_t)];
    setting_t s;
    look(&s, which);
    uint8_t *place = place_of(&s, 0);
    uint8_t bytes = s.format.kind >= VECTOR ? (uint8_t)(AXES * s.format.size) : s.format.size;
    memcpy(before, place, bytes);
    setting_answer_t answer = take(&s, text) ? judge(&s) : SETTING_ILLEGAL;
    *starts = which == SETTING_FILTER || memcmp(before, place, bytes) != 0 ? s.format.starts : 0;
    if (answer != SETTING_TAKEN) {
        memcpy(place, before, bytes);
    }
    return answer;
}

static void write_axes(void)
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

static void write_value(const setting_t *s, uint32_t value)
{
    uint8_t i = 0;
    if (s->format.kind == SIGNED_AXES) {
        write_axes();
    } else if (s->format.kind == WORDS) {
        while (choice(s, i) != value) {
            i++;
        }
        text_words(word(s, i));
    } else if (s->which == SETTING_RATE) {
        text_tenths((uint16_t)value);
    } else {
        number_write(value, s->format.fraction_bits);
    }
}

void setting_write(uint8_t which)
{
    setting_t s;
    look(&s, which);
    text_words(setting_name(which));
    for (uint8_t i = 0; i < numbers(&s); i++) {
        text_char(' ');
        write_value(&s, value_of(&s, i));
    }
    flash_text_t unit = which < SETTING_PARAMETERS ? text_nth(units, which) : parameter_of(which)->unit;
    if (flash_char(unit) != '\0') {
        text_char(' ');
        text_words(unit);
    }
}

static void write_range(const setting_t *s)
{
    number_write((uint32_t)s->least, s->format.fraction_bits);
    text_words(FLASH_TEXT(" to "));
    number_write((uint32_t)s->most, s->format.fraction_bits);
    if (s->zero_is_off) {
        text_words(FLASH_TEXT(", 0: off"));
    }
}

void setting_write_legal(uint8_t which)
{
    setting_t s;
    look(&s, which);
    if (s.format.kind == SIGNED_AXES) {
        text_words(FLASH_TEXT("24 like xyz or -yxz"));
    } else if (s.format.kind > LIST) {
        write_range(&s);
    } else {
        for (uint8_t i = 0; i < s.most; i++) {
            if (i != 0) {
                text_char(' ');
            }
            write_value(&s, choice(&s, i));
        }
    }
}
