/* The table; see settings_table.h. */
#include "settings/settings_table.h"

#include <stddef.h>

#include "base/text.h"
#include "filter_list.h"
#include "hal_uart.h"
#include "settings/settings.h"
#include "settings/settings_row.h"
#include "settings/settings_words.h"

/* Values of the lists, at the same index as their words if they have any. */
/* clang-format off */
#define KIND(F) FILTER_KIND_##F,
static const uint16_t choices[] IN_FLASH = {
    FILTER_LIST(KIND)
    MODE_CSV, MODE_PLOT,
    0, 0x53, 0x1D,                                /* address; 0: whichever answers */
    0, 48, 32,                                    /* i2c: adxl345_i2c_t */
    125, 250, 500, 1000, 2000, 4000, 8000,        /* rate, 0.1 Hz */
    2, 4, 8, 16,                                  /* range */
    96, 192, 384, 576,                            /* baud, in hundreds */
#if HAL_UART_REACHES(115200)
    1152,
#endif
    2500, 5000,
#if HAL_UART_REACHES(1000000)
    10000
#endif
};
enum { RATE = WORDS_END, RANGE = RATE + 7, BAUD = RANGE + 4, BAUD_UNIT = 100 };
enum { LISTED = sizeof choices / sizeof choices[0] };
enum { OFFSET_MAX = CALIBRATION_OFFSET_MAX_LSB_Q4, LEVEL_MAX_Q14 = 18841 }; /* 1.15 g */

/*
 * Name, unit, offset in settings_t, bytes of a number there, kind, fraction bits, what a change starts, and the range;
 * for a list, where it starts in `choices` and its length. Vectors are finally judged by calibration_check.
 */
#define SETTINGS(X) \
    X("filter", "", choice.filter, 1, WORDS, 0, STARTS_FILTER, WORD_FILTER, WORD_MODE) \
    X("rate", "Hz", rate_dhz, 2, LIST, 6, STARTS_SENSOR, RATE, RANGE - RATE) \
    X("range", "g", range_g, 1, LIST, 0, STARTS_SENSOR, RANGE, BAUD - RANGE) \
    X("every", "", every, 2, NUMBER, 0, 0, 1, SETTINGS_EVERY_MAX) \
    X("baud", "", baud, 4, LIST, 0, STARTS_LINE, BAUD, LISTED - BAUD) \
    X("mode", "", mode, 1, WORDS, 0, 0, WORD_MODE, WORD_ADDRESS - WORD_MODE) \
    X("address", "", address, 1, WORDS, 0, STARTS_SENSOR, WORD_ADDRESS, WORD_I2C - WORD_ADDRESS) \
    X("i2c", "", i2c, 1, WORDS, 0, STARTS_SENSOR, WORD_I2C, WORDS_END - WORD_I2C) \
    X("axes", "", calibration.axes, 1, SIGNED_AXES, 0, STARTS_CALIBRATION, 0, 0) \
    X("offset", "LSB", calibration.offset_lsb_q4, 2, VECTOR, 4, STARTS_CALIBRATION, -OFFSET_MAX, OFFSET_MAX) \
    X("scale", "LSB/g", calibration.scale_lsb_per_g_uq6, 2, VECTOR, 6, STARTS_CALIBRATION, CALIBRATION_SCALE_MIN_UQ6, \
      CALIBRATION_SCALE_MAX_UQ6) \
    X("level", "", calibration.level_q14, 2, VECTOR, 14, STARTS_CALIBRATION, -LEVEL_MAX_Q14, LEVEL_MAX_Q14)
/* clang-format on */

typedef struct {
    format_t format;
    int16_t least, most;
} row_t;

#define WORDS_OF(name, unit, ...) name "\0" unit "\0"
#define ROW(name, unit, member, size, kind, bits, starts, least, most) \
    { { offsetof(settings_t, member), size, kind, bits, starts }, least, most },
static const char words[] IN_FLASH = SETTINGS(WORDS_OF); /* as in parameters: the unit after the name */
static const row_t rows[] IN_FLASH = { SETTINGS(ROW) };

_Static_assert(sizeof rows / sizeof rows[0] == SETTING_PARAMETERS, "a row for each setting");
_Static_assert(CALIBRATION_SCALE_MAX_UQ6 <= INT16_MAX, "two bytes are read with sign");
_Static_assert(offsetof(settings_t, calibration) + sizeof(calibration_t) <= UINT8_MAX, "a place has a byte");

static const filter_law_t *law_in_force(void)
{
    return choice_law(&settings()->choice);
}

static void look_at_row(setting_t *s, uint8_t which)
{
    const row_t *row = &rows[which];
    MACHINE_POINTER(row);
    const uint8_t *from = (const uint8_t *)row;
    uint8_t *to = (uint8_t *)&s->format;
    for (uint8_t left = sizeof s->format; left != 0; left--) {
        *to++ = flash_u8(from++);
    }
    s->least = (int16_t)flash_u16((const uint16_t *)&row->least);
    s->most = (int16_t)flash_u16((const uint16_t *)&row->most);
    s->zero_is_off = false;
}

/* The descriptor of a filter parameter, in program memory. */
static const filter_parameter_t *parameter_of(uint8_t which)
{
    return filter_parameter(law_in_force(), (uint8_t)(which - SETTING_PARAMETERS));
}

static void look_at_parameter(setting_t *s, uint8_t which)
{
    const filter_parameter_t *parameter = parameter_of(which);
    enum { EACH = sizeof((settings_t *)0)->choice.parameters[0] };
    uint8_t place = (uint8_t)(offsetof(settings_t, choice.parameters) +
                              (uint16_t)(uint8_t)(which - SETTING_PARAMETERS) * EACH);
    s->format = (format_t){ place, sizeof((settings_t *)0)->choice.parameters[0], NUMBER,
                            flash_u8(&parameter->fraction_bits), STARTS_FILTER };
    s->least = (int32_t)flash_u32((const uint32_t *)&parameter->min);
    s->most = (int32_t)flash_u32((const uint32_t *)&parameter->max);
    s->zero_is_off = flash_u8(&parameter->zero_means_off) != 0;
}

void setting_look(setting_t *s, uint8_t which)
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
    return which < SETTING_PARAMETERS ? text_nth(words, (uint8_t)(2u * which))
                                      : filter_parameter_words(parameter_of(which));
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

uint32_t setting_choice(const setting_t *s, uint8_t i)
{
    uint16_t value = flash_u16(&choices[(uint8_t)(s->least + i)]);
    return s->which == SETTING_BAUD ? (uint32_t)value * BAUD_UNIT : value;
}
