/*
 * All the words that the firmware says in answer to something, in program memory. reply_lines.c speaks them: a byte
 * below ' ' is one of enum say, one from SHARED_WORD on is a word that texts share. Each line gets "# " in front. Main
 * only.
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
#define V_DEVICE_ID "\x15"
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
    SAY_ADDRESS, /* of the sensor, and what it reads as DEVID */
    SAY_DEVICE_ID,
    SAY_MORE,           /* another line follows */
    SAY_MORE_IF_FORCED, /* it follows if another `every` is in force than was asked for */
    SAY_THEN_CAUSE,     /* goes on in another text: one for each cause of a reset */
    SAY_THEN_SAFE,      /* in a text on safe settings, if they are in force */
    SAY_THEN_LEGAL,     /* ... setting */
    SAY_THEN_FAULT,     /* ... fault code */
    SAY_THEN_STATE,     /* ... phase of the driver */
    SAY_THEN_WHY,       /* why this `every` is in force, if it was not asked for */
    SAY_THEN_MODE,      /* ... output mode */
    SAY_THEN_REST       /* the rest of the line of the state */
};

/* Bytes from SHARED_WORD on: the texts at the head of the list, which are words that others share. */
#define SHARED_WORD 0x80u
#define W_HELP "\x80"
#define W_STATUS "\x81"
#define W_FILTER "\x82"
#define W_RATE "\x83"
#define W_RANGE "\x84"
#define W_EVERY "\x85"
#define W_BAUD "\x86"
#define W_MODE "\x87"
#define W_STOP "\x88"
#define W_GO "\x89"
#define W_CHECK "\x8A"
#define W_PULL_UPS "\x8B"
#define W_SENSOR "\x8C"
#define W_AT "\x8D"
#define W_REFUSED "\x8E"
#define W_THE "\x8F"
#define W_TO "\x90"
#define W_SAMPLE "\x91"
#define W_FAULT "\x92"
#define W_LOST "\x93"
#define W_SUPPLY "\x94"
#define W_ADXL "\x95"
#define W_HZ "\x96"
#define W_THAT "\x97"
#define W_NOT "\x98"
#define W_HELD_LOW "\x99"
#define W_COMMA "\x9A"

#define SMALLEST ": " W_THE "smallest" W_THAT

/*
 * First the words that others share, those of the commands before the rest; then one text for each reply_kind_t, in
 * its order; then the others, those that belong together in their order. Not formatted: aligned ends of the lines would
 * all change with the longest.
 */
/* clang-format off */
#define REPLY_TEXTS(X) \
    X(NAME_HELP, "help") \
    X(NAME_STATUS, "status") \
    X(NAME_FILTER, "filter") \
    X(NAME_RATE, "rate") \
    X(NAME_RANGE, "range") \
    X(NAME_EVERY, "every") \
    X(NAME_BAUD, "baud") \
    X(NAME_MODE, "mode") \
    X(NAME_STOP, "stop") \
    X(NAME_GO, "go") \
    X(WORD_CHECK, ": check ") \
    X(WORD_PULL_UPS, ", pull-ups, GND") \
    X(WORD_SENSOR, "sensor") \
    X(WORD_AT, " at ") \
    X(WORD_REFUSED, "refused: ") \
    X(WORD_THE, "the ") \
    X(WORD_TO, " to ") \
    X(WORD_SAMPLE, "sample") \
    X(WORD_FAULT, "fault ") \
    X(WORD_LOST, " lost") \
    X(WORD_SUPPLY, "supply") \
    X(WORD_ADXL, " ADXL345") \
    X(WORD_HZ, " Hz") \
    X(WORD_THAT, " that ") \
    X(WORD_NOT, " not ") \
    X(WORD_HELD_LOW, " held low") \
    X(WORD_COMMA, ", ") \
    X(WHO, FIRMWARE_NAME " " FIRMWARE_VERSION ": roll and pitch from an" W_ADXL V_MORE) \
    X(HELP, V_NAME ": " V_MORE V_THEN_LEGAL) \
    X(STATUS, "state " V_THEN_STATE) \
    X(FILTER_NOW, W_FILTER " " V_FILTER V_MORE_IF_FORCED) \
    X(RATE_NOW, W_RATE " " V_RATE W_HZ W_COMMA "I2C" W_AT V_BUS_KHZ " kHz" V_MORE_IF_FORCED) \
    X(RANGE_NOW, W_RANGE " " V_RANGE " g" W_COMMA "256 LSB per g") \
    X(EVERY_NOW, W_EVERY " " V_EVERY V_THEN_WHY) \
    X(BAUD_NOW, W_BAUD " " V_BAUD V_MORE_IF_FORCED) \
    X(MODE_NOW, W_MODE " " V_THEN_MODE) \
    X(STOPPED, W_STOP "ped") \
    X(GOING, "going") \
    X(UNKNOWN, "unknown command (type " W_HELP ")") \
    X(REFUSED, W_REFUSED V_NAME " is one of " V_THEN_LEGAL) \
    X(TOO_SLOW, W_REFUSED V_FILTER " takes " V_CYCLES " of " W_THE V_LEFT " cycles" W_THAT \
                                   "a " W_SAMPLE W_AT V_RATE W_HZ " leaves") \
    X(FAULT_BEGIN, W_FAULT V_SUBJECT ": " V_THEN_FAULT) \
    X(FAULT_END, W_FAULT V_SUBJECT " over: " W_SAMPLE "s again after " V_OUTAGE_MS " ms" W_COMMA V_OUTAGE_LOST W_LOST \
                   W_COMMA W_SENSOR W_AT "0x" V_OUTAGE_ADDRESS) \
    X(RESET, "reset: " V_MORE V_THEN_CAUSE) \
    X(SETTINGS, W_FILTER " " V_FILTER W_COMMA W_RATE " " V_RATE W_HZ W_COMMA W_RANGE " " V_RANGE " g" \
                         W_COMMA W_EVERY " " V_EVERY W_COMMA W_BAUD " " V_BAUD V_MORE) \
    X(HINT, "type " W_HELP W_COMMA "or " W_MODE " plot for " W_THE "Arduino plotter" V_MORE) \
    X(SENSOR, W_SENSOR ":" W_ADXL W_AT "0x" V_ADDRESS W_COMMA "I2C" W_AT V_BUS_KHZ " kHz" V_MORE) \
    X(HEADER, "t_us,x_lsb,y_lsb,z_lsb,x_mg,y_mg,z_mg,roll_cdeg,pitch_cdeg,flags") \
    X(VERBS, W_STOP W_COMMA "go" W_COMMA "status" W_COMMA W_HELP "; NAME VALUE sets" W_COMMA "NAME shows") \
    X(TOO_LONG, W_REFUSED "line too long") \
    X(GARBAGE, W_REFUSED "characters" W_THAT "no command has") \
    X(SAMPLES, W_SAMPLE "s " V_COUNT W_COMMA "gated " V_COUNT W_COMMA "reacquired " V_COUNT \
      W_COMMA "clipped " V_COUNT V_MORE) \
    X(ROWS, "rows " V_COUNT W_COMMA "dropped " V_COUNT W_COMMA "serial bytes" W_LOST " " V_SERIAL_LOST \
            W_COMMA "lines refused " V_COUNT V_MORE) \
    X(MISSING, "lost " V_COUNT W_COMMA "late " V_COUNT W_COMMA "drained " V_COUNT W_COMMA "stuck " V_COUNT \
      W_COMMA "restarts " V_COUNT V_MORE) \
    X(BUS, \
      "not acknowledged " V_COUNT W_COMMA "arbitration" W_LOST " " V_COUNT W_COMMA "bus errors " V_COUNT \
      W_COMMA "timeouts " V_COUNT V_MORE) \
    X(READINGS, "readings torn " V_COUNT W_COMMA "empty " V_COUNT W_COMMA "overruns " V_COUNT V_MORE) \
    X(RESET_AGAIN, "reset: " V_THEN_CAUSE) \
    X(LINE_CARRIES, SMALLEST V_BAUD " " W_BAUD " carries" W_AT V_RATE W_HZ) \
    X(FILTER_LEAVES, SMALLEST V_FILTER " leaves time for" W_AT V_RATE W_HZ) \
    X(CSV, "csv") \
    X(PLOT, "plot") \
    X(LEGAL_FILTER, V_FILTERS) \
    X(LEGAL_RATE, "12.5 25 50 100 200 400 800") \
    X(LEGAL_RANGE, "2 4 8 16") \
    X(LEGAL_EVERY, "1 to 10000") \
    X(LEGAL_BAUD, "9600 19200 38400 57600 115200 250000 500000 1000000") \
    X(LEGAL_MODE, "csv plot") \
    X(POWER_ON, "power on") \
    X(EXTERNAL, "reset button or serial port opened") \
    X(BROWN_OUT, W_SUPPLY " dropped") \
    X(WATCHDOG, "watchdog" W_COMMA "waiting for stage mask " V_NOTE " (1 sampling" W_COMMA "2 " W_FILTER "ing" \
      W_COMMA "4 output)" V_THEN_SAFE) \
    X(SAFE, W_COMMA "again and again: safe settings") \
    X(STATE_STOPPED, W_STOP "ped" V_THEN_REST) \
    X(STATE_STARTING, "starting" V_THEN_REST) \
    X(STATE_STREAMING, "streaming" V_THEN_REST) \
    X(STATE_QUIESCING, "starting" V_THEN_REST) \
    X(STATE_FAULTY, "fault" V_THEN_REST) \
    X(STATE_REST, W_COMMA W_FAULT V_FAULT W_COMMA W_RATE " " V_RATE W_HZ W_COMMA "measured " V_MEASURED W_HZ \
      W_COMMA "uptime s " V_COUNT \
                  V_MORE) \
    X(NO_SENSOR, \
      "no " W_SENSOR " answers" W_AT "0x53 or 0x1D" W_CHECK "power" W_COMMA "SDA" W_TO "A4" W_COMMA "SCL" W_TO "A5" \
      W_COMMA "CS" W_TO "3.3 V") \
    X(WRONG_ID, W_THE "device" W_AT "0x" V_ADDRESS " is no" W_ADXL ": DEVID reads 0x" V_DEVICE_ID "," W_NOT "0xE5") \
    X(BUS_FAULT, "I2C bus stuck or disturbed" W_CHECK "SDA" W_COMMA "SCL" W_PULL_UPS) \
    X(READ_BACK, "a register does" W_NOT "keep its value" W_CHECK W_SUPPLY W_COMMA "bus") \
    X(INT1_SILENT, W_THE W_SENSOR " has data" W_COMMA "but INT1 does" W_NOT "rise" W_CHECK "INT1" W_TO "D2") \
    X(NO_DATA, W_THE W_SENSOR " " W_STOP "ped measuring: power" W_LOST "?") \
    X(SCL_LOW, "SCL" W_HELD_LOW W_CHECK "SCL" W_TO "A5" W_PULL_UPS) \
    X(SDA_LOW, "SDA" W_HELD_LOW W_CHECK "SDA" W_TO "A4" W_PULL_UPS) \
    X(INT1_STUCK, "INT1 is high without data" W_CHECK "INT1" W_TO "D2") \
    X(STUCK, W_THE "values do" W_NOT "change" W_CHECK W_SUPPLY W_COMMA "bus") \
    X(TORN, "readings are torn" W_CHECK "SDA" W_COMMA "SCL" W_COMMA W_SUPPLY W_PULL_UPS) \
    X(TWO_SENSORS, "values jump to their double" W_CHECK "for two " W_SENSOR "s" W_AT "0x" V_ADDRESS)
/* clang-format on */

#define REPLY_TEXT_ID(name, words) TEXT_##name,
enum reply_text { REPLY_TEXTS(REPLY_TEXT_ID) TEXT_NONE };
#undef REPLY_TEXT_ID

/* Where a text (enum reply_text) begins. */
flash_text_t reply_text(uint8_t id);

#endif
