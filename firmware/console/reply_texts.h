/*
 * All texts of the replies. A byte below ' ' or from 0x7F on is one of enum say: a value, or another text to insert.
 * Each line is preceded by "# ". Main only.
 */
#ifndef REPLY_TEXTS_H
#define REPLY_TEXTS_H

#include <stdint.h>

#include "base/replies.h"
#include "console/version.h"

/* The bytes of enum say, to be placed between the words. */
#define V_COUNT "\x01"
#define V_SERIAL_LOST "\x02"
#define V_CYCLES "\x03"
#define V_LEFT "\x04"
#define V_RESIDUAL "\x05"
#define V_TO_GO "\x06"
#define V_RUN_NOTE "\x07"
#define V_OUTAGE_MS "\x08"
#define V_OUTAGE_LOST "\x09"
#define V_SUBJECT "\x0A"
#define V_ADDRESS "\x0B"
#define V_OUTAGE_ADDRESS "\x0C"
#define V_FOREIGN_ADDRESS "\x0D"
#define V_FOREIGN_ID "\x0E"
#define V_SHIFT "\x0F"
#define V_RMS "\x10"
#define V_R "\x11"
#define V_OFF "\x12"
#define V_NAME "\x13"
#define V_SETTING_NAME "\x14"
#define V_SETTING "\x15"
#define V_LEGAL "\x16"
#define V_SETTINGS "\x17"
#define V_VERBS "\x18"
#define V_RATE "\x19"
#define V_MEASURED "\x1A"
#define V_BUS_KHZ "\x1B"
#define V_POSITION "\x1C"
#define V_AXIS "\x1D"
#define V_CHOICES "\x1E"
#define V_CAUSE "\x7B"
#define V_SAFE "\x7C"
#define V_STATE "\x7D"
#define V_KEPT "\x7E"
#define V_LIMITS "\x7F"
#define V_VERDICT "\x80"
#define V_FAULT_WORDS "\x81"
#define V_SETTING_NOTE "\x82"
#define V_EVERY "\x83"
#define V_SENSOR "\x84"
#define V_LISTED "\x85"
#define V_HEADER "\x86"
#define V_BUS "\x87"
#define V_CHECK_BUS "\x88"
#define V_WHO "\x89"
#define V_KEEP "\x8A"
#define V_LINE "\x8B"
#define V_LINE_IF_FORCED "\x8C"
#define V_LINE_IF_CSV "\x8D"
#define V_AGAIN "\x8E"

/*
 * From SAY_ALONE on, above the characters used in texts, codes are not packed with others: those that continue in
 * another text and, from SAY_LINE on, those that end a line, which occur only in texts of whole lines.
 */
enum say {
    SAY_COUNT = 1, /* numbers: the next counter of the firmware, then of the driver */
    SAY_SERIAL_LOST,
    SAY_CYCLES, /* cycles that the filter would take, and those left for it */
    SAY_LEFT,
    SAY_RESIDUAL,  /* of cal6, mg */
    SAY_TO_GO,     /* how many positions are still missing */
    SAY_RUN_NOTE,  /* the note of the run before the reset */
    SAY_OUTAGE_MS, /* how long the last fault lasted, and how many samples it cost */
    SAY_OUTAGE_LOST,
    SAY_SUBJECT, /* what the line is about: a fault's code */
    SAY_LAST_NUMBER = SAY_SUBJECT,
    SAY_ADDRESS,         /* hexadecimal: of the sensor */
    SAY_OUTAGE_ADDRESS,  /* where the sensor was when the last fault ended */
    SAY_FOREIGN_ADDRESS, /* of a device that is not an ADXL345, and what it reads as DEVID */
    SAY_FOREIGN_ID,
    SAY_LAST_HEXADECIMAL = SAY_FOREIGN_ID,
    SAY_SHIFT, /* of the line's axis, by the self-test */
    SAY_RMS,   /* in Q8, for the line's axis */
    SAY_R,
    SAY_OFF, /* deviation of the measured rate from the nominal one, % */
    SAY_LAST_Q8 = SAY_OFF,
    SAY_NAME,         /* of the command that the line is about */
    SAY_SETTING_NAME, /* of the setting that the line is about */
    SAY_SETTING,      /* its name, value and unit */
    SAY_LEGAL,        /* its legal values */
    SAY_SETTINGS,     /* those in the banner */
    SAY_VERBS,        /* all commands */
    SAY_RATE,         /* Hz, nominal and measured */
    SAY_MEASURED,
    SAY_BUS_KHZ,
    SAY_POSITION, /* of cal6: the sensor's axis that points up */
    SAY_AXIS,     /* of measurements */
    SAY_CHOICES,  /* those of the supervisor, if it is in force */
    SAY_ALONE = 0x7B,
    SAY_CAUSE = SAY_ALONE, /* texts: of a reset */
    SAY_SAFE,              /* safe settings, if they are in force */
    SAY_STATE,             /* phase of the driver */
    SAY_KEPT,              /* where the settings come from */
    SAY_LIMITS,            /* of the self-test */
    SAY_VERDICT,           /* on the line's axis */
    SAY_FAULT_WORDS,
    SAY_SETTING_NOTE, /* printed after a setting's value */
    SAY_EVERY,        /* the setting `every`, after another setting */
    SAY_SENSOR,       /* at the start of a line, once: sensor's address or fault; waits for it, starts the watch */
    SAY_LISTED,       /* from here to KEEP: the text of the same name */
    SAY_HEADER,       /* at the start of a line, without "# " */
    SAY_BUS,
    SAY_CHECK_BUS,
    SAY_WHO,
    SAY_KEEP,
    SAY_LINE,           /* the line ends here and another follows */
    SAY_LINE_IF_FORCED, /* ... if the `every` in force is not the requested one; else this was the last */
    SAY_LINE_IF_CSV,    /* ... if the mode is csv */
    SAY_AGAIN,          /* the line repeats for the next subject, as often as needed */
    SAY_PAIR            /* from here on pairs of packed texts */
};

/*
 * The replies (replies.h), then the texts within them, related ones in the order of their enum.
 * mk/scripts/pack_texts.py packs them into program memory (reply_packed.h). Not formatted: the aligned line ends would
 * all change with the longest.
 */
/* clang-format off */
#define REPLY_TEXTS(X, COMMAND) \
    REPLIES(X, COMMAND) \
    X(SENSOR, "sensor: ADXL345 at 0x" V_ADDRESS V_BUS) \
    X(ILLEGAL_NUMBER, "refused 4: illegal value; " V_SETTING ": " V_LEGAL) \
    X(ROWS_SETTING, V_SETTING V_SETTING_NOTE V_LINE_IF_FORCED V_EVERY) \
    X(MODE_SET, V_SETTING V_LINE_IF_CSV V_HEADER) \
    X(LISTED, V_SETTING V_SETTING_NOTE ": " V_LEGAL) \
    X(HEADER, "t_us,x_lsb,y_lsb,z_lsb,x_mg,y_mg,z_mg,roll_cdeg,pitch_cdeg,flags") \
    X(BUS, ", I2C at " V_BUS_KHZ " kHz") \
    X(CHECK_BUS, ": check SDA, SCL, pull-ups, GND") \
    X(WHO, FIRMWARE_NAME " " FIRMWARE_VERSION ": roll and pitch from an ADXL345") \
    X(KEEP, "in force now; type save to keep it") \
    X(ODR_UNKNOWN, "odr: not measured yet") \
    X(LIMITS_XY, "88.5 to 955.8: " V_VERDICT) \
    X(LIMITS_Z, "110.25 to 1286.25: " V_VERDICT) \
    X(FAIL, "FAIL") \
    X(PASS, "pass") \
    X(HIGH, "high") \
    X(HOLD_STILL, V_NAME ": hold still") \
    X(MOVED, "refused 8: moving") \
    X(ABORTED, "refused 9: samples lost or settings changed") \
    X(CAL_STOPPED, "cal6: stopped") \
    X(POSITION, "cal6: " V_POSITION " up, " V_TO_GO " to go") \
    X(REPEATED, "cal6: " V_POSITION " up again: try another") \
    X(TILTED, "refused 11: " V_POSITION " is 20 degrees off or more") \
    X(OFFSET, "refused 11: illegal offset of " V_AXIS) \
    X(SCALE, "refused 11: illegal scale of " V_AXIS) \
    X(RESIDUAL, "refused 11: " V_POSITION " does not fit the others") \
    X(WRONG_AXES, "") \
    X(NO_GRAVITY, "refused 11: not 1 g") \
    X(LINE_CARRIES, ": the least for this baud rate") \
    X(FILTER_LEAVES, ": the least for this filter") \
    X(POWER_ON, "power on") \
    X(EXTERNAL, "reset button or serial port opened") \
    X(BROWN_OUT, "supply dropped") \
    X(WATCHDOG, "watchdog, stage mask " V_RUN_NOTE V_SAFE) \
    X(SAFE, ", repeatedly: safe settings") \
    X(STATE_STOPPED, "stopped") \
    X(STATE_STARTING, "starting") \
    X(STATE_STREAMING, "streaming") \
    X(STATE_QUIESCING, "starting") \
    X(STATE_FAULTY, "fault") \
    X(KEPT_DAMAGED, "defaults, saved ones damaged") \
    X(KEPT_EMPTY, "defaults, none saved") \
    X(KEPT_OTHER_VERSION, "defaults, saved by another version") \
    X(KEPT_GOOD, "as saved") \
    X(KEPT_OLDER, "as saved, other copy damaged") \
    X(KEPT_NO_FILTER, "as saved, but another filter") \
    X(KEPT_UNREAD, "defaults, saved ones not read") \
    X(KEPT_CALIBRATION, "defaults but calibration, saved by another version") \
    X(NOT_SAVED, "refused 7: EEPROM failed") \
    X(NO_SENSOR, "no sensor at 0x53 or 0x1D: check power, SDA to A4, SCL to A5, CS to 3.3 V") \
    X(WRONG_ID, "no ADXL345 at 0x" V_FOREIGN_ADDRESS ": DEVID 0x" V_FOREIGN_ID ", not 0xE5") \
    X(BUS_FAULT, "I2C bus disturbed" V_CHECK_BUS) \
    X(READ_BACK, "a register lost its value: check supply, bus") \
    X(INT1_SILENT, "INT1 stays low: check INT1 to D2") \
    X(NO_DATA, "the sensor stopped: check supply") \
    X(SCL_LOW, "SCL held low" V_CHECK_BUS) \
    X(SDA_LOW, "SDA held low" V_CHECK_BUS) \
    X(INT1_STUCK, "INT1 stays high: check INT1 to D2") \
    X(STUCK, "values do not change: check supply, bus") \
    X(TORN, "torn readings" V_CHECK_BUS) \
    X(TWO_SENSORS, "values double: two sensors at 0x" V_ADDRESS) \
    X(INT1_FLICKERS, "INT1 flickers: check INT1 to D2") \
    X(OTHER_PART, "not an ADXL345, or offsets beyond its data sheet: cal6") \
    X(I2C_SLOWED, "I2C at 100 kHz up to 200 Hz" V_CHECK_BUS)
/* clang-format on */

#define REPLY_TEXT_ID(name, ...) TEXT_##name,
enum reply_text { REPLY_TEXTS(REPLY_TEXT_ID, REPLY_TEXT_ID) TEXT_NONE };
#undef REPLY_TEXT_ID

/* At most this many second bytes of pairs wait while the first one is a pair again. */
enum { REPLY_PAIRS_DEPTH = 16 };

/* The bytes of a text, packed, in program memory; terminated by 0. */
const uint8_t *reply_text(uint8_t text);

/* The first or second byte that a code from SAY_PAIR on represents: another such code, or a byte of the text. */
uint8_t reply_pair(uint8_t code, uint8_t half);

#endif
