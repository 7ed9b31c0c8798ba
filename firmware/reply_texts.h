/*
 * All the words that the firmware says in answer to something. reply_lines.c speaks them: a byte below ' ' or from 0x7F
 * on is one of enum say. Each line gets "# " in front. Main only.
 */
#ifndef REPLY_TEXTS_H
#define REPLY_TEXTS_H

#include <stdint.h>

#include "flash.h"
#include "version.h"

/* The bytes of enum say, to be written between the words. */
#define V_COUNT "\x01"
#define V_FAULT "\x02"
#define V_MEASURED "\x03"
#define V_SERIAL_LOST "\x04"
#define V_CYCLES "\x05"
#define V_LEFT "\x06"
#define V_RANGE "\x07"
#define V_EVERY "\x08"
#define V_BAUD "\x09"
#define V_OUTAGE_ADDRESS "\x0A"
#define V_NOTE "\x0B"
#define V_SUBJECT "\x0C"
#define V_OUTAGE_MS "\x0D"
#define V_OUTAGE_LOST "\x0E"
#define V_NAME "\x0F"
#define V_FILTER "\x10"
#define V_RATE "\x11"
#define V_BUS_KHZ "\x12"
#define V_FILTERS "\x13"
#define V_ADDRESS "\x14"
#define V_FOREIGN_ID "\x15"
#define V_MORE "\x16"
#define V_MORE_IF_FORCED "\x17"
#define V_THEN_CAUSE "\x18"
#define V_THEN_SAFE "\x19"
#define V_THEN_LEGAL "\x1A"
#define V_THEN_FAULT "\x1B"
#define V_THEN_STATE "\x1C"
#define V_THEN_WHY "\x1D"
#define V_THEN_MODE "\x1E"
#define V_THEN_REST "\x1F"
#define V_FOREIGN_ADDRESS "\x7F"
#define V_PARAMETER "\x80"
#define V_SET_ADDRESS "\x81"
#define V_AXES "\x82"
#define V_AXIS "\x83"
#define V_SHIFT "\x84"
#define V_RMS "\x85"
#define V_R "\x86"
#define V_OFF "\x87"
#define V_POSITION "\x88"
#define V_RESIDUAL "\x89"
#define V_TO_GO "\x8A"
#define V_PARAMETER_RANGE "\x8B"
#define V_THEN_KEPT "\x8C"
#define V_THEN_LIMITS "\x8D"
#define V_THEN_VERDICT "\x8E"
#define V_THEN_CHOICES "\x8F"

enum say {
    SAY_COUNT = 1, /* numbers: the next of the counters of the firmware, then of the driver */
    SAY_FAULT,
    SAY_MEASURED, /* output data rate */
    SAY_SERIAL_LOST,
    SAY_CYCLES, /* that the filter takes, and that are left for it */
    SAY_LEFT,
    SAY_RANGE,
    SAY_EVERY, /* in force */
    SAY_BAUD,
    SAY_OUTAGE_ADDRESS, /* where the sensor was when the last fault was over */
    SAY_NOTE,           /* what the run before the reset left */
    SAY_SUBJECT,        /* the reply's argument, a fault code */
    SAY_OUTAGE_MS,      /* how long the last fault was, and how many samples are missing of its time */
    SAY_OUTAGE_LOST,
    SAY_NAME,   /* of the setting that the line is about */
    SAY_FILTER, /* as set, or as asked for where that was refused */
    SAY_RATE,
    SAY_BUS_KHZ,
    SAY_FILTERS, /* the image's */
    SAY_ADDRESS, /* of the sensor */
    SAY_FOREIGN_ID,
    SAY_MORE,                   /* another line follows */
    SAY_MORE_IF_FORCED,         /* it follows if another `every` is in force than was asked for */
    SAY_THEN_CAUSE,             /* goes on in another text: one for each cause of a reset */
    SAY_THEN_SAFE,              /* in a text on safe settings, if they are in force */
    SAY_THEN_LEGAL,             /* ... setting */
    SAY_THEN_FAULT,             /* ... fault code */
    SAY_THEN_STATE,             /* ... phase of the driver */
    SAY_THEN_WHY,               /* why this `every` is in force, if it was not asked for */
    SAY_THEN_MODE,              /* ... output mode */
    SAY_THEN_REST,              /* the rest of the line of the state */
    SAY_FOREIGN_ADDRESS = 0x7F, /* of a device that is no ADXL345; SAY_FOREIGN_ID is what it reads as DEVID */
    SAY_PARAMETER,              /* of the filter: name, value, unit */
    SAY_SET_ADDRESS,
    SAY_AXES,
    SAY_AXIS,  /* of measurements: the axis of the line */
    SAY_SHIFT, /* by the self-test */
    SAY_RMS,
    SAY_R,
    SAY_OFF,      /* how far the measured rate is from the nominal one, % */
    SAY_POSITION, /* of cal6: which of the sensor's axes points up */
    SAY_RESIDUAL,
    SAY_TO_GO, /* how many positions are not known yet */
    SAY_PARAMETER_RANGE,
    SAY_THEN_KEPT,    /* goes on in another text: what the settings began as */
    SAY_THEN_LIMITS,  /* ... the limits of the self-test */
    SAY_THEN_VERDICT, /* ... what they say of the line's axis */
    SAY_THEN_CHOICES, /* goes on with those of the supervisor, where it is in force */
};

/* The commands, a name for each reply_kind_t from REPLY_HELP on, in its order: as typed. */
#define REPLY_NAMES(X) \
    X("help")          \
    X("status")        \
    X("filter")        \
    X("rate")          \
    X("range")         \
    X("every")         \
    X("baud")          \
    X("mode")          \
    X("address")       \
    X("axes")          \
    X("stop")          \
    X("go")            \
    X("save")          \
    X("load")          \
    X("defaults")      \
    X("odr")           \
    X("noise")         \
    X("selftest")      \
    X("tare")          \
    X("cal")           \
    X("cal6")          \
    X("settings")

/*
 * One text for each reply_kind_t, in its order; then the others, those that belong together in their order. They are
 * packed into program memory by tools/pack_texts.py (reply_packed.h). Not formatted: aligned ends of the lines would
 * all change with the longest.
 */
/* clang-format off */
#define REPLY_TEXTS(X) \
    X(WHO, FIRMWARE_NAME " " FIRMWARE_VERSION ": roll and pitch from an ADXL345" V_MORE) \
    X(HELP, V_NAME ": " V_MORE V_THEN_LEGAL) \
    X(STATUS, "state " V_THEN_STATE) \
    X(FILTER_NOW, "filter " V_FILTER V_MORE_IF_FORCED) \
    X(RATE_NOW, "rate " V_RATE " Hz, I2C at " V_BUS_KHZ " kHz" V_MORE_IF_FORCED) \
    X(RANGE_NOW, "range " V_RANGE " g") \
    X(EVERY_NOW, "every " V_EVERY V_THEN_WHY) \
    X(BAUD_NOW, "baud " V_BAUD V_MORE_IF_FORCED) \
    X(MODE_NOW, "mode " V_THEN_MODE) \
    X(ADDRESS_NOW, "address " V_SET_ADDRESS) \
    X(AXES_NOW, "axes " V_AXES) \
    X(STOPPED, "stopped") \
    X(GOING, "going") \
    X(SAVED, "saved") \
    X(LOADED, "settings: " V_THEN_KEPT) \
    X(DEFAULTS, "settings: defaults") \
    X(ODR, "odr " V_MEASURED " Hz, " V_OFF " % from " V_RATE " Hz") \
    X(NOISE, "noise " V_AXIS " " V_RMS " LSB rms, R " V_R " LSB^2") \
    X(SELFTEST, "selftest " V_AXIS " " V_SHIFT " LSB, " V_THEN_LIMITS) \
    X(TARE, "") \
    X(CAL, "") \
    X(CAL6, "cal6: residual " V_RESIDUAL " mg") \
    X(LISTING, "settings") \
    X(PARAMETER, V_PARAMETER V_PARAMETER_RANGE) \
    X(ILLEGAL_PARAMETER, "refused 4: illegal value; " V_PARAMETER V_PARAMETER_RANGE) \
    X(UNKNOWN, "refused 1: unknown command (type help)") \
    X(REFUSED, "refused 4: " V_NAME " is one of " V_THEN_LEGAL) \
    X(TOO_SLOW, "refused 5: " V_FILTER " takes " V_CYCLES " of the " V_LEFT " cycles that a sample at " V_RATE \
      " Hz leaves") \
    X(STREAMING, "refused 6: type stop first") \
    X(BUSY, "refused 10: one measurement at a time") \
    X(NO_ROOM, "refused 12: not in this image; cal6 in another one, then save there") \
    X(FAULT_BEGIN, "fault " V_SUBJECT ": " V_THEN_FAULT) \
    X(FAULT_END, "fault " V_SUBJECT " over: samples again after " V_OUTAGE_MS " ms, " V_OUTAGE_LOST \
      " lost, sensor at 0x" V_OUTAGE_ADDRESS) \
    X(RESET, "reset: " V_MORE V_THEN_CAUSE) \
    X(SETTINGS, "filter " V_FILTER ", rate " V_RATE " Hz, range " V_RANGE " g, every " V_EVERY ", baud " V_BAUD \
      V_MORE) \
    X(KEPT, "settings: " V_MORE V_THEN_KEPT) \
    X(HINT, "type help, or mode plot for the Arduino plotter" V_MORE) \
    X(SENSOR, "sensor: ADXL345 at 0x" V_ADDRESS ", I2C at " V_BUS_KHZ " kHz" V_MORE) \
    X(HEADER, "t_us,x_lsb,y_lsb,z_lsb,x_mg,y_mg,z_mg,roll_cdeg,pitch_cdeg,flags") \
    X(VERBS, "stop, go, save, load, defaults, status, settings, odr, noise, selftest, tare, cal, cal6, help; " \
      "NAME VALUE sets") \
    X(ODR_UNKNOWN, "odr: not measured yet") \
    X(LIMITS_XY, "88.5 to 955.8: " V_THEN_VERDICT) \
    X(LIMITS_Z, "110.25 to 1286.25: " V_THEN_VERDICT) \
    X(FAIL, "FAIL") \
    X(PASS, "pass") \
    X(HIGH, "high") \
    X(HOLD_STILL, V_NAME ": hold still") \
    X(MOVED, "refused 8: moving") \
    X(ABORTED, "refused 9: samples lost, or another configuration") \
    X(CAL_STOPPED, "cal6: stopped") \
    X(POSITION, "cal6: " V_POSITION " up, " V_TO_GO " to go") \
    X(REPEATED, "cal6: " V_POSITION " up again: another, please") \
    X(TILTED, "refused 11: " V_POSITION " was not up, but 20 degrees off or more") \
    X(OFFSET, "refused 11: offset of " V_AXIS " is not legal") \
    X(SCALE, "refused 11: scale of " V_AXIS " is not legal") \
    X(RESIDUAL, "refused 11: " V_POSITION " up does not fit the others") \
    X(AXES, "") \
    X(NO_GRAVITY, "refused 11: not 1 g") \
    X(TOO_LONG, "refused 2: line too long") \
    X(GARBAGE, "refused 3: characters that no command has") \
    X(SAMPLES, "samples " V_COUNT ", gated " V_COUNT ", reacquired " V_COUNT ", clipped " V_COUNT V_MORE) \
    X(ROWS, "rows " V_COUNT ", dropped " V_COUNT ", serial bytes lost " V_SERIAL_LOST ", lines refused " V_COUNT \
      V_MORE) \
    X(MISSING, "lost " V_COUNT ", late " V_COUNT ", drained " V_COUNT ", stuck " V_COUNT ", restarts " V_COUNT V_MORE) \
    X(BUS, "not acknowledged " V_COUNT ", arbitration lost " V_COUNT ", bus errors " V_COUNT ", timeouts " V_COUNT \
      V_MORE) \
    X(READINGS, "readings torn " V_COUNT ", empty " V_COUNT ", overruns " V_COUNT V_MORE) \
    X(RESET_AGAIN, "reset: " V_THEN_CAUSE) \
    X(LINE_CARRIES, ": the smallest that " V_BAUD " baud carries at " V_RATE " Hz") \
    X(FILTER_LEAVES, ": the smallest that " V_FILTER " leaves time for at " V_RATE " Hz") \
    X(CSV, "csv") \
    X(PLOT, "plot") \
    X(LEGAL_FILTER, V_FILTERS) \
    X(LEGAL_RATE, "12.5 25 50 100 200 400 800") \
    X(LEGAL_RANGE, "2 4 8 16") \
    X(LEGAL_EVERY, "1 to 10000") \
    X(LEGAL_BAUD, "9600 19200 38400 57600 115200 250000 500000 1000000") \
    X(LEGAL_MODE, "csv plot") \
    X(LEGAL_ADDRESS, "auto 53 1d") \
    X(LEGAL_AXES, "24 like xyz or -yxz") \
    X(POWER_ON, "power on") \
    X(EXTERNAL, "reset button or serial port opened") \
    X(BROWN_OUT, "supply dropped") \
    X(WATCHDOG, "watchdog, waiting for stage mask " V_NOTE " (1 sampling, 2 filtering, 4 output)" V_THEN_SAFE) \
    X(SAFE, ", again and again: safe settings") \
    X(STATE_STOPPED, "stopped" V_THEN_REST) \
    X(STATE_STARTING, "starting" V_THEN_REST) \
    X(STATE_STREAMING, "streaming" V_THEN_REST) \
    X(STATE_QUIESCING, "starting" V_THEN_REST) \
    X(STATE_FAULTY, "fault" V_THEN_REST) \
    X(STATE_REST, ", fault " V_FAULT ", rate " V_RATE " Hz, measured " V_MEASURED " Hz, uptime s " V_COUNT \
      V_THEN_CHOICES V_MORE) \
    X(KEPT_DAMAGED, "defaults, the saved ones are damaged") \
    X(KEPT_EMPTY, "defaults, none saved") \
    X(KEPT_OTHER_VERSION, "defaults, the saved ones are of another version") \
    X(KEPT_GOOD, "as saved") \
    X(KEPT_OLDER, "as saved; the other copy is damaged") \
    X(KEPT_NO_FILTER, "as saved, but for the filter") \
    X(KEPT_UNREAD, "defaults, the saved ones are left alone") \
    X(NOT_SAVED, "refused 7: the EEPROM does not keep a byte") \
    X(NO_SENSOR, "no sensor answers at 0x53 or 0x1D: check power, SDA to A4, SCL to A5, CS to 3.3 V") \
    X(WRONG_ID, "the device at 0x" V_FOREIGN_ADDRESS " is no ADXL345: DEVID reads 0x" V_FOREIGN_ID ", not 0xE5") \
    X(BUS_FAULT, "I2C bus stuck or disturbed: check SDA, SCL, pull-ups, GND") \
    X(READ_BACK, "a register does not keep its value: check supply, bus") \
    X(INT1_SILENT, "the sensor has data, but INT1 does not rise: check INT1 to D2") \
    X(NO_DATA, "the sensor stopped measuring: power lost?") \
    X(SCL_LOW, "SCL held low: check SCL to A5, pull-ups, GND") \
    X(SDA_LOW, "SDA held low: check SDA to A4, pull-ups, GND") \
    X(INT1_STUCK, "INT1 is high without data: check INT1 to D2") \
    X(STUCK, "the values do not change: check supply, bus") \
    X(TORN, "readings are torn: check SDA, SCL, supply, pull-ups, GND") \
    X(TWO_SENSORS, "values jump to their double: check for two sensors at 0x" V_ADDRESS)
/* clang-format on */

#define REPLY_TEXT_ID(name, words) TEXT_##name,
enum reply_text { REPLY_TEXTS(REPLY_TEXT_ID) TEXT_NONE };
#undef REPLY_TEXT_ID

/* Begins with a text (enum reply_text); reply_text_next gives its bytes one by one, then 0. One text at a time. */
void reply_text_open(uint8_t id);
uint8_t reply_text_next(void);

/* The name of a command, counted from 0 in REPLY_NAMES, in program memory. */
flash_text_t reply_name(uint8_t command);

#endif
