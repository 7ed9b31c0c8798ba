/* Selects the text of reply_texts.h for a reply, what it is about, and keeps track of how far it is out. */
#include "console/reply_lines.h"

#include <stdbool.h>

#include "adxl345.h"
#include "base/notices.h"
#include "base/text.h"
#include "console/reply_said.h"
#include "console/reply_texts.h"
#include "control/calibrate.h"
#include "control/measure.h"
#include "control/sensor_watch.h"
#include "machine.h"
#include "settings/settings.h"
#include "settings/settings_table.h"
#include "settings/store.h"

_Static_assert(TEXT_LIMITED - TEXT_BANNER == (int)NOTICE_LIMITED, "a text for each reply");
_Static_assert(TEXT_REPEATED - TEXT_HOLD_STILL == MEASURE_REPEATED - MEASURE_BEGUN, "words for each outcome");
_Static_assert(TEXT_NO_GRAVITY - TEXT_TILTED == CALIBRATION_NO_GRAVITY - CALIBRATION_TILTED, "words for each verdict");

/* Nested texts: FAULT_BEGIN in the banner, the fault's words in that, CHECK_BUS at the end of those. */
enum { TEXTS_DEPTH = 3 };

static const uint8_t *at; /* where the reply continues; NULL: none has begun */
static said_t said;
static uint8_t again; /* how often the line still repeats */

static uint8_t setting_text(void)
{
    bool changed = (said.subject & NOTICE_CHANGED) != 0;
    said.subject = (uint8_t)(said.subject & ~NOTICE_CHANGED);
    switch (said.subject) {
    case SETTING_FILTER:
    case SETTING_RATE:
    case SETTING_BAUD:
        return TEXT_ROWS_SETTING;
    case SETTING_MODE:
        return changed ? TEXT_MODE_SET : TEXT_SETTING;
    default:
        return said.subject >= SETTING_OFFSET ? TEXT_LISTED : TEXT_SETTING;
    }
}

/* The results by axis, the new vectors, or why there is no result. */
static uint8_t measured_text(uint8_t kind)
{
    uint8_t outcome = said.subject;
    if (outcome == MEASURE_WRONG) {
        said.subject = calibrate_report()->verdict.where;
        return (uint8_t)(TEXT_TILTED - CALIBRATION_TILTED + calibrate_report()->verdict.why);
    }
    if (outcome != MEASURE_DONE) {
        said.subject = outcome == MEASURE_BEGUN ? kind : calibrate_report()->position;
        return (uint8_t)(TEXT_HOLD_STILL - MEASURE_BEGUN + outcome);
    }
    if (kind < NOTICE_TARE) {
        said.subject = 0;
        again = 2;
    } else {
        said.subject = kind == NOTICE_TARE ? SETTING_LEVEL : SETTING_OFFSET;
        again = kind == NOTICE_CAL6;
    }
    return (uint8_t)(TEXT_BANNER + kind);
}

/* TEXT_NONE: what is to be reported is not known yet. */
static uint8_t text_of(uint8_t kind)
{
    switch (kind) {
    case NOTICE_STATUS:
        said.subject = sensor_watch_fault();
        said.counters_out = 0;
        break;
    case NOTICE_HELP:
    case NOTICE_LISTING:
        again = (uint8_t)(settings_count() - 1u);
        break;
    case NOTICE_SETTING:
        return setting_text();
    case NOTICE_ILLEGAL:
        return said.subject >= SETTING_OFFSET ? TEXT_ILLEGAL_NUMBER : TEXT_ILLEGAL;
    case NOTICE_SAVED:
        return store_busy() ? TEXT_NONE : store_failed() ? TEXT_NOT_SAVED : TEXT_SAVED;
    case NOTICE_ODR:
        return adxl345_rate_chz() == 0 ? TEXT_ODR_UNKNOWN : TEXT_ODR;
    default:
        if (kind >= NOTICE_NOISE && kind <= NOTICE_CAL6) {
            return measured_text(kind);
        }
    }
    return (uint8_t)(TEXT_BANNER + kind);
}

/* Starts a line, or waits. */
static bool begin_line(void)
{
    uint8_t code = flash_u8(at);
    if (code == SAY_SENSOR && adxl345_fault() == ADXL345_FAULT_NONE && adxl345_phase() != ADXL345_STREAMING) {
        return false;
    }
    if (code != SAY_HEADER) {
        text_words(FLASH_TEXT("# "));
    }
    return true;
}

/* Evaluates the code at the end of a line; true: another line follows. */
static bool goes_on(uint8_t code)
{
    if (code == SAY_LINE_IF_FORCED) {
        return settings_every_in_force() != settings()->every;
    }
    return code == SAY_LINE || (code == SAY_LINE_IF_CSV && settings()->mode == MODE_CSV);
}

/* Texts being unpacked. */
typedef struct {
    const uint8_t *from;
    const uint8_t *outer[TEXTS_DEPTH]; /* where the enclosing texts continue */
    uint8_t seconds[REPLY_PAIRS_DEPTH];
    uint8_t texts;
    uint8_t pairs;
} unpacking_t;

static void open_text(unpacking_t *u, uint8_t text)
{
    if (text != TEXT_NONE) {
        u->outer[u->texts++] = u->from;
        u->from = reply_text(text);
    }
}

/* The next byte of the line; 0: there is no more. */
static uint8_t next_code(unpacking_t *u)
{
    while (u->pairs == 0 && u->texts != 0 && flash_u8(u->from) == 0) {
        u->from = u->outer[--u->texts];
    }
    uint8_t code = u->pairs != 0 ? u->seconds[--u->pairs] : flash_u8(u->from++);
    while (code >= SAY_PAIR) {
        u->seconds[u->pairs++] = reply_pair(code, 1);
        code = reply_pair(code, 0);
    }
    return code;
}

/* Writes the rest of the line; returns where the next one begins, NULL after the last. */
static const uint8_t *write_line(void)
{
    unpacking_t u;
    u.from = at;
    u.texts = 0;
    u.pairs = 0;
    for (;;) {
        uint8_t code = next_code(&u);
        if (code == SAY_AGAIN) {
            if (again != 0) {
                again--;
                said.subject++;
                return at;
            }
        } else if (code == 0 || code >= SAY_LINE) {
            return goes_on(code) ? u.from : 0;
        } else {
            open_text(&u, say(&said, code));
        }
    }
}

void reply_start(void)
{
    at = 0;
}

bool reply_ended(void)
{
    return at == 0;
}

bool reply_line(uint8_t kind, uint8_t argument)
{
    if (reply_ended()) {
        said.subject = argument;
        again = 0;
        uint8_t text = text_of(kind);
        if (text == TEXT_NONE) {
            return false;
        }
        at = reply_text(text);
    }
    if (!begin_line()) {
        return false;
    }
    at = write_line();
    text_close();
    return true;
}
