/* Typed text to values and back; see settings_table.h. Values are stored as in settings.h and filter.h. */
#include <stddef.h>

#include "base/number.h"
#include "base/text.h"
#include "settings/settings.h"
#include "settings/settings_row.h"
#include "settings/settings_table.h"
#include "settings/settings_words.h"

enum { AXES = 3 };

/* The build names the filters that this image lacks, FILTERS_ELSEWHERE(X), if there are any. */
#ifdef FILTERS_ELSEWHERE
#define AFTER_SPACE(filter) " " #filter
#define OTHER_IMAGES "; make flash FILTERS=NAME:" FILTERS_ELSEWHERE(AFTER_SPACE)
#else
#define OTHER_IMAGES ""
#endif

static uint8_t numbers(const setting_t *s)
{
    return s->format.kind == VECTOR ? AXES : 1;
}

static uint8_t *place_of(const setting_t *s, uint8_t number)
{
    uint8_t size = s->format.size;
    return (uint8_t *)settings() + s->format.place + (uint8_t)((uint16_t)number * size);
}

/* Little-endian on PC and chip, as settings.h requires; all numbers are signed. */
static uint32_t value_of(const setting_t *s, uint8_t number)
{
    if (s->which >= SETTING_PARAMETERS) {
        return choice_value(&settings()->choice, settings()->rate_dhz, (uint8_t)(s->which - SETTING_PARAMETERS));
    }
    if (s->which == SETTING_EVERY) {
        return settings_every_in_force();
    }
    const uint8_t *at = place_of(s, number) + s->format.size;
    uint32_t value = (uint32_t)(int32_t)(int8_t) * --at;
    for (uint8_t left = s->format.size; --left != 0;) {
        value = value << 8 | *--at;
    }
    return value;
}

static void put(const setting_t *s, uint8_t number, uint32_t value)
{
    uint8_t *at = place_of(s, number);
    uint8_t left = s->format.size;
    do {
        *at++ = (uint8_t)value;
        value >>= 8;
    } while (--left != 0);
}

static flash_text_t word(const setting_t *s, uint8_t i)
{
    return settings_word((uint8_t)(s->least + i));
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
    *place_of(s, 0) = (uint8_t)setting_choice(s, i); /* what has words takes one byte */
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
        if (setting_choice(s, i) == value) {
            return true;
        }
    }
    return false;
}

/* A rate has 6 fraction bits, in which each legal one is exact, and is stored in tenths: false with a remainder. */
static bool to_tenths(uint32_t *value)
{
    uint32_t tenths_q5 = *value * 5u;
    *value = tenths_q5 >> 5;
    return ((uint8_t)tenths_q5 & 31u) == 0;
}

static bool take_numbers(const setting_t *s, const char *text)
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

/*
 * x, y, z in any order, with a sign if reversed; calibration_check refuses one that comes twice. A mirror image is
 * refused: a board cannot be mounted that way.
 */
static bool take_axes(const char *text)
{
    int8_t axis = 0;
    int8_t previous = 0;
    bool mirrored = true;
    for (uint8_t i = 0; i < AXES; i++) {
        bool reversed = *text == '-';
        text += reversed;
        previous = axis;
        axis = (int8_t)(*text++ - ('x' - 1));
        if (axis < 1 || axis > AXES) {
            return false;
        }
        mirrored ^= reversed;
        settings()->calibration.axes[i] = (int8_t)(reversed ? -axis : axis);
    }
    int8_t step = (int8_t)(axis - previous);
    bool turned = step == 1 || step == 1 - AXES; /* y after x, z after y, x after z */
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

/* Judges all settings including the new one; one of the filter's parameters becomes the user's own. */
static setting_answer_t judge(const setting_t *s)
{
    if (s->which >= SETTING_PARAMETERS) {
        filter_choice_t *choice = &settings()->choice;
        choice->own = (uint8_t)(choice->own | 1u << (s->which - SETTING_PARAMETERS));
        return choice_legal(choice, settings()->rate_dhz) ? SETTING_TAKEN : SETTING_ILLEGAL;
    }
    if (!settings_fit(settings()->choice.filter, settings()->rate_dhz)) {
        return SETTING_TOO_SLOW;
    }
    return calibration_check(&settings()->calibration).why == CALIBRATION_GOOD ? SETTING_TAKEN : SETTING_ILLEGAL;
}

/* Bytes of the largest setting; those after a smaller one stay as they are. */
enum { PLACE_BYTES = AXES * sizeof(int16_t) };
_Static_assert((int)PLACE_BYTES >= (int)sizeof(uint32_t) &&
                   offsetof(settings_t, address) + PLACE_BYTES <= sizeof(settings_t),
               "of every setting, and within the settings after the last one");

/* Copies a setting's bytes to where they are kept; true: they differ from the previous ones. */
static bool keep(uint8_t *to, const uint8_t *from)
{
    bool differ = false;
    for (uint8_t left = PLACE_BYTES; left != 0; left--, to++, from++) {
        if (*to != *from) {
            *to = *from;
            differ = true;
        }
    }
    return differ;
}

setting_answer_t setting_set(uint8_t which, const char *text, uint8_t *starts)
{
    static uint8_t before[PLACE_BYTES];
    setting_t s;
    setting_look(&s, which);
    uint8_t *place = place_of(&s, 0);
    uint8_t own = settings()->choice.own;
    (void)keep(before, place);
    setting_answer_t answer = take(&s, text) ? judge(&s) : SETTING_ILLEGAL;
    *starts = 0;
    if (answer != SETTING_TAKEN) {
        (void)keep(place, before);
        settings()->choice.own = own;
    } else if (keep(before, place) || own != settings()->choice.own) { /* own: the value may be as before */
        *starts = s.format.starts;
        if (which == SETTING_FILTER) {
            settings_take_filter(settings()->choice.filter);
        }
    }
    return answer;
}

static void write_axes(void)
{
    for (uint8_t i = 0; i < AXES; i++) {
        int8_t axis = settings()->calibration.axes[i];
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
        while (setting_choice(s, i) != value) {
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
    setting_look(&s, which);
    flash_text_t name = setting_name(which);
    text_words(name);
    for (uint8_t i = 0; i < numbers(&s); i++) {
        text_char(' ');
        write_value(&s, value_of(&s, i));
    }
    flash_text_t unit = text_nth(name, 1);
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
    setting_look(&s, which);
    if (s.format.kind == SIGNED_AXES) {
        text_words(FLASH_TEXT("24 like xyz or -yxz"));
    } else if (s.format.kind > LIST) {
        write_range(&s);
    } else {
        for (uint8_t i = 0; i < (uint8_t)s.most; i++) {
            if (i != 0) {
                text_char(' ');
            }
            write_value(&s, setting_choice(&s, i));
        }
        if (which == SETTING_FILTER) {
            text_words(FLASH_TEXT(OTHER_IMAGES));
        }
    }
}
