/* Which text of reply_texts.h makes a line of a reply, and whether another line follows. */
#include "reply_lines.h"

#include <stdbool.h>

#include "adxl345.h"
#include "calibrate.h"
#include "flash.h"
#include "measure.h"
#include "replies.h"
#include "reply_said.h"
#include "reply_texts.h"
#include "settings.h"
#include "settings_table.h"
#include "store.h"
#include "text.h"

enum { BANNER_DIAGNOSIS = 5, HELP_SETTINGS = SETTING_OFFSET };

_Static_assert(TEXT_FAULT_END - TEXT_WHO == (int)REPLY_FAULT_END, "a text for each reply");
_Static_assert(TEXT_REPEATED - TEXT_HOLD_STILL == MEASURE_REPEATED - MEASURE_BEGUN, "words for each outcome");
_Static_assert(TEXT_NO_GRAVITY - TEXT_TILTED == CALIBRATION_NO_GRAVITY - CALIBRATION_TILTED, "words for each verdict");

/* The texts of a banner follow each other; one waits for the sensor, or reports what is wrong with it. */
static uint8_t banner_text(uint8_t line)
{
    adxl345_fault_t fault = adxl345_fault();
    said.more = TEXT_RESET - 1 + line != TEXT_HEADER;
    if (line == 0) {
        return TEXT_WHO;
    }
    if (line == BANNER_DIAGNOSIS) {
        if (fault != ADXL345_FAULT_NONE) {
            said.subject = (uint8_t)fault;
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
    said.subject = line;
    said.more = line < HELP_SETTINGS;
    return said.more ? TEXT_HELP : TEXT_VERBS;
}

static uint8_t listing_text(uint8_t line)
{
    said.subject = line;
    said.more = line + 1u != settings_count();
    return TEXT_LISTED;
}

/* What may have changed the mode: where it is csv now, the header follows. */
static uint8_t text_and_header(uint8_t text, uint8_t line)
{
    said.more = line == 0 && settings.mode == MODE_CSV;
    return line == 0 ? text : (uint8_t)TEXT_HEADER;
}

/* After a setting that rows depend on, what it makes of `every`. */
static uint8_t setting_text(uint8_t line)
{
    bool changed = (said.subject & REPLY_CHANGED) != 0;
    said.subject = (uint8_t)(said.subject & ~REPLY_CHANGED);
    if (said.subject >= SETTING_OFFSET) {
        return TEXT_LISTED;
    }
    if (said.subject == SETTING_MODE && changed) {
        return text_and_header(TEXT_SETTING, line);
    }
    if (line != 0) {
        said.subject = SETTING_EVERY;
    } else if (said.subject == SETTING_FILTER || said.subject == SETTING_RATE || said.subject == SETTING_BAUD) {
        said.more = settings_every_in_force() != settings.every;
    }
    return TEXT_SETTING;
}

static uint8_t status_text(uint8_t line)
{
    if (line == 0) {
        said.counters_out = 0;
        said.more = true;
        return TEXT_STATUS;
    }
    uint8_t text = (uint8_t)(TEXT_SAMPLES - 1 + line);
    said.more = text != TEXT_RESET;
    return text;
}

static uint8_t saved_text(void)
{
    if (store_busy()) {
        return TEXT_NONE;
    }
    return store_failed() ? TEXT_NOT_SAVED : TEXT_SAVED;
}

/* The vectors that are new; of cal6 the residual before them. */
static uint8_t calibrated_text(uint8_t kind, uint8_t line)
{
    said.subject = kind == REPLY_TARE ? SETTING_LEVEL : SETTING_OFFSET;
    if (kind == REPLY_CAL6) {
        said.more = line < 2;
        if (line == 0) {
            return TEXT_CAL6;
        }
        said.subject = (uint8_t)(SETTING_OFFSET - 1 + line);
    }
    return TEXT_LISTED;
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
    said.more = line < 2;
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
    case REPLY_SETTING:
        return setting_text(line);
    case REPLY_ILLEGAL:
        return said.subject >= SETTING_OFFSET ? TEXT_ILLEGAL_NUMBER : TEXT_ILLEGAL;
    case REPLY_SAVED:
        return saved_text();
    case REPLY_ODR:
        return adxl345_rate_chz() == 0 ? (uint8_t)TEXT_ODR_UNKNOWN : (uint8_t)TEXT_ODR;
    case REPLY_LOADED:
    case REPLY_DEFAULTS:
        return text_and_header((uint8_t)(TEXT_WHO + kind), line);
    default:
        return kind >= REPLY_NOISE && kind <= REPLY_CAL6 ? measured_text(kind, line) : (uint8_t)(TEXT_WHO + kind);
    }
}

reply_progress_t reply_line(uint8_t kind, uint8_t argument, uint8_t line)
{
    said.subject = argument;
    said.more = false;
    uint8_t text = text_of(kind, line);
    if (text == TEXT_NONE) {
        return REPLY_WAITS;
    }
    if (text != TEXT_HEADER) {
        text_words(FLASH_TEXT("\n# ") + (text != TEXT_WHO)); /* the first ends a line that a reset has cut */
    }
    say(text);
    text_close();
    return said.more ? REPLY_GOES_ON : REPLY_ENDED;
}
