/* Which texts of reply_texts.h make a reply's lines, and how far the one that is being spoken has come. */
#include "reply_lines.h"

#include <stdbool.h>

#include "adxl345.h"
#include "calibrate.h"
#include "flash.h"
#include "fx.h"
#include "measure.h"
#include "parameters.h"
#include "pass.h"
#include "reply_said.h"
#include "reply_texts.h"
#include "settings.h"
#include "store.h"
#include "text.h"

#define RATE_LOWEST_DHZ 125u
#define COMBINATION_RATE 16u

enum { BANNER_DIAGNOSIS = 5, HELP_VERBS = REPLY_SETTINGS_END - REPLY_FILTER };

_Static_assert(FILTER_KIND_COUNT <= COMBINATION_RATE, "a filter's kind has four bits in reply_combination");
_Static_assert(TEXT_FAULT_END - TEXT_WHO == (int)REPLY_FAULT_END, "a text for each reply");
_Static_assert(TEXT_LEGAL_AXES - TEXT_LEGAL_FILTER == REPLY_AXES - REPLY_FILTER, "legal values for each setting");
_Static_assert(TEXT_REPEATED - TEXT_HOLD_STILL == MEASURE_REPEATED - MEASURE_BEGUN, "words for each outcome");
_Static_assert(TEXT_NO_GRAVITY - TEXT_TILTED == CALIBRATION_NO_GRAVITY - CALIBRATION_TILTED, "words for each verdict");

static uint8_t listed_progress; /* of the line of a listing, which its texts do not decide; else REPLY_SPEAKS */

flash_text_t reply_command_name(uint8_t kind)
{
    return reply_name((uint8_t)(kind - REPLY_HELP));
}

/* The rates are 12.5 Hz times a power of two: its exponent above four bits of the filter's kind. */
uint8_t reply_combination(uint8_t filter, uint16_t rate_dhz)
{
    for (; rate_dhz > RATE_LOWEST_DHZ; rate_dhz >>= 1) {
        filter = (uint8_t)(filter + COMBINATION_RATE);
    }
    return filter;
}

/* The texts of a banner follow each other; one waits for the sensor, and says instead what is wrong with it. */
static uint8_t banner_text(uint8_t line)
{
    adxl345_fault_t fault = adxl345_fault();
    if (line == 0) {
        return TEXT_WHO;
    }
    if (line == BANNER_DIAGNOSIS) {
        if (fault != ADXL345_FAULT_NONE) {
            said.subject = (uint8_t)fault;
            said.progress = REPLY_GOES_ON;
            return TEXT_FAULT_BEGIN;
        }
        if (adxl345_phase() != ADXL345_STREAMING) {
            return TEXT_NONE;
        }
    }
    return (uint8_t)(TEXT_RESET - 1 + line);
}

static uint8_t help_text(uint8_t line)
{
    said.subject = (uint8_t)(REPLY_FILTER + line);
    return line < HELP_VERBS ? TEXT_HELP : TEXT_VERBS;
}

/* The settings with what is legal, then the parameters. */
static uint8_t listing_text(uint8_t line)
{
    bool last = line + 1u == (uint8_t)(HELP_VERBS + parameters_count());
    listed_progress = last ? REPLY_ENDED : REPLY_GOES_ON;
    if (line >= HELP_VERBS) {
        said.subject = (uint8_t)(line - HELP_VERBS);
        return TEXT_PARAMETER;
    }
    said.subject = (uint8_t)(REPLY_FILTER + line);
    said.listed = true;
    return (uint8_t)(TEXT_FILTER_NOW + line);
}

/* What may have changed the mode: where it is csv now, the header follows. */
static uint8_t text_and_header(uint8_t kind, uint8_t line)
{
    if (line != 0) {
        return TEXT_HEADER;
    }
    if (settings.mode == MODE_CSV) {
        said.progress = REPLY_GOES_ON;
    }
    return (uint8_t)(TEXT_WHO + kind);
}

/* A setting that rows depend on, and then what it makes of `every`. */
static uint8_t setting_text(uint8_t kind, uint8_t line)
{
    if (kind == REPLY_MODE && said.subject != 0) {
        return text_and_header(kind, line);
    }
    return (uint8_t)(TEXT_WHO + (line == 0 ? kind : (uint8_t)REPLY_EVERY));
}

static uint8_t too_slow_text(void)
{
    said.filter = said.subject % COMBINATION_RATE;
    said.rate_dhz = (uint16_t)(RATE_LOWEST_DHZ << (said.subject / COMBINATION_RATE));
    return TEXT_TOO_SLOW;
}

static uint8_t status_text(uint8_t line)
{
    if (line == 0) {
        said.counters_out = 0;
        return TEXT_STATUS;
    }
    return (uint8_t)(TEXT_SAMPLES - 1 + line);
}

static uint8_t saved_text(void)
{
    if (store_busy()) {
        return TEXT_NONE;
    }
    return store_failed() ? TEXT_NOT_SAVED : TEXT_SAVED;
}

/* The vectors of parameters.h that are new; of cal6 the residual before them. */
static uint8_t calibrated_text(uint8_t kind, uint8_t line)
{
    enum { OFFSET, SCALE, LEVEL };
    if (kind != REPLY_CAL6) {
        said.subject = kind == REPLY_TARE ? LEVEL : OFFSET;
        return TEXT_PARAMETER;
    }
    said.progress = line < 2 ? REPLY_GOES_ON : REPLY_ENDED;
    if (line == 0) {
        return TEXT_CAL6;
    }
    said.subject = (uint8_t)(OFFSET - 1 + line);
    return TEXT_PARAMETER;
}

/* A line for each axis, or why there is no result. */
static uint8_t measured_text(uint8_t kind, uint8_t line)
{
    uint8_t outcome = said.subject;
    said.subject = kind;
    if (outcome == MEASURE_WRONG) {
        said.axis = calibrate_told.verdict.where;
        return (uint8_t)(TEXT_TILTED - CALIBRATION_TILTED + calibrate_told.verdict.why);
    }
    if (outcome != MEASURE_DONE) {
        said.axis = calibrate_told.position;
        return (uint8_t)(TEXT_HOLD_STILL - MEASURE_BEGUN + outcome);
    }
    if (kind >= REPLY_TARE) {
        return calibrated_text(kind, line);
    }
    said.axis = line;
    said.progress = line < 2 ? REPLY_GOES_ON : REPLY_ENDED;
    return (uint8_t)(TEXT_WHO + kind);
}

static uint8_t text_of(uint8_t kind, uint8_t line)
{
    switch (kind) {
    case REPLY_BANNER:
        return banner_text(line);
    case REPLY_HELP:
        return help_text(line);
    case REPLY_STATUS:
        return status_text(line);
    case REPLY_LISTING:
        return listing_text(line);
    case REPLY_UNKNOWN:
        return said.subject == PROBLEM_COMMAND ? (uint8_t)TEXT_UNKNOWN : (uint8_t)(TEXT_TOO_LONG - 1 + said.subject);
    case REPLY_SAVED:
        return saved_text();
    case REPLY_ODR:
        return adxl345_rate_chz() == 0 ? (uint8_t)TEXT_ODR_UNKNOWN : (uint8_t)TEXT_ODR;
    case REPLY_NOISE:
    case REPLY_SELFTEST:
    case REPLY_TARE:
    case REPLY_CAL:
    case REPLY_CAL6:
        return measured_text(kind, line);
    case REPLY_TOO_SLOW:
        return too_slow_text();
    case REPLY_LOADED:
    case REPLY_DEFAULTS:
        return text_and_header(kind, line);
    default:
        return kind < REPLY_SETTINGS_END ? setting_text(kind, line) : (uint8_t)(TEXT_WHO + kind);
    }
}

/* The text in which the line goes on; false: there is none. */
static bool open_next(void)
{
    if (said.listed && said.next == TEXT_NONE) {
        said.listed = false;
        text_words(FLASH_TEXT(": "));
        said.next = (uint8_t)(TEXT_LEGAL_FILTER - REPLY_FILTER + said.subject);
    }
    uint8_t id = said.next;
    said.next = TEXT_NONE;
    if (id != TEXT_NONE) {
        reply_text_open(id);
    }
    return id != TEXT_NONE;
}

bool reply_begin_line(reply_kind_t kind, uint8_t argument, uint8_t line)
{
    said.rate_dhz = settings.rate_dhz;
    said.filter = settings.filter;
    said.subject = argument;
    said.progress = REPLY_ENDED;
    listed_progress = REPLY_SPEAKS;
    uint8_t id = text_of((uint8_t)kind, line);
    said.next = id;
    if (id == TEXT_NONE) {
        return false;
    }
    if (id != TEXT_HEADER) {
        text_words(FLASH_TEXT("\n# ") + (id != TEXT_WHO)); /* the first ends a line that a reset has cut */
    }
    return open_next();
}

reply_progress_t reply_speak(void)
{
    do {
        uint8_t c = reply_text_next();
        if (c != 0) {
            say_byte(c);
        } else if (!open_next()) {
            text_close();
            return (reply_progress_t)(listed_progress != REPLY_SPEAKS ? listed_progress : said.progress);
        }
    } while (pass_in_time());
    return REPLY_SPEAKS;
}
