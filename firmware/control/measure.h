/*
 * Measurements that a command asks for, of samples at rest: `selftest` (what the sensor's own force does to its
 * readings), `noise` (how much they scatter), and the means for `tare`, `cal` and `cal6` (calibrate.h). One at a time.
 * Main only.
 *
 * All but `selftest` look at the samples that the filters get too. `selftest` borrows them: no row goes out while the
 * sensor is set otherwise. What comes between (a fault, another rate or range, stop, go, too much time) ends a
 * measurement without a result; what has no influence on it (filter, every, mode, baud) does not.
 */
#ifndef MEASURE_H
#define MEASURE_H

#include <stdbool.h>
#include <stdint.h>

#include "adxl345.h"
#include "rest.h"

/* The argument of a reply of a measuring command. */
typedef enum {
    MEASURE_BEGUN, /* another reply follows */
    MEASURE_MOVED,
    MEASURE_ABORTED,  /* samples were lost, or the sensor's configuration has changed */
    MEASURE_STOPPED,  /* `cal6 stop` */
    MEASURE_POSITION, /* from here on calibrate.h: one of several; another reply follows */
    MEASURE_REPEATED, /* the same */
    MEASURE_WRONG,    /* no calibration can be made of it */
    MEASURE_DONE,     /* the results, which hold until the reply is out */
    MEASURE_UNCHANGED /* never reported */
} measure_outcome_t;

/*
 * 256 samples each. Self-test as the data sheet wants it (p. 22, 31): a rate of 100 to 800 Hz, 16 g, means of 0.1 s or
 * more before and with the force, four samples after its change; at 400 Hz it takes 1.4 s. Noise over 2 s or more: of
 * 200, 400 and 800 Hz every second, fourth and eighth sample; its rms is within 9 % (2 / sqrt(2 x 256)) of the true one
 * in 19 of 20 cases.
 */
enum { MEASURE_SELFTEST_DHZ = 4000, MEASURE_SELFTEST_G = 16, MEASURE_SETTLE = 4 };

/* Once at start-up: nothing runs. */
void measure_reset(void);

/* Begins what this command (notice_kind_t) asks for, whose reply follows; false: another runs. */
bool measure_start(uint8_t kind);

/* One runs, or its reply is not out yet. */
bool measure_runs(void);

/* Every pass of the main loop, after adxl345_poll: ends what has failed, and reports what is over. */
void measure_pass(void);

/* A sample has come. True: it is not for the filters. */
bool measure_sample(const int16_t lsb[3]);

/* Samples are not for the filters now. */
bool measure_borrows(void);

/* The configuration of the sensor or its state changes by command: what runs ends without a result. */
void measure_abort(void);

/* Ends cal6 if that runs; nothing is reported. */
void measure_stop(void);

/* What a measurement wants of the sensor, in place of the settings' configuration; nothing: it stays as it is. */
void measure_configure(adxl345_config_t *config);

/* The sensor is to follow measure_configure: told once. */
bool measure_asks(void);

/*
 * The configuration that was asked for is in force from the next sample on. True: it is that of the settings again, and
 * the filters, which have missed samples, are to restart.
 */
bool measure_configured(void);

/* The results of MEASURE_DONE, by axis: the readings of the last rest, */
const rest_t *measure_rest(void);

/* and their mean, LSB in Q4; of a self-test what the force has added to it. */
int16_t measure_result_lsb_q4(uint8_t axis);

#endif
