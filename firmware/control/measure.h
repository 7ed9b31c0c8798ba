/*
 * Measurements at rest, started by commands: `selftest` (how the sensor's own force changes its readings), `noise` (how
 * much they scatter), and the means for `tare`, `cal` and `cal6` (calibrate.h). One at a time. Main only.
 *
 * All but `selftest` use samples that the filters get too. `selftest` borrows them: no row goes out while the sensor is
 * configured for it. A disturbance (a fault, another rate or range, stop, go, too much time) ends a measurement without
 * a result; what does not affect it (filter, every, mode, baud) does not.
 */
#ifndef MEASURE_H
#define MEASURE_H

#include <stdbool.h>
#include <stdint.h>

#include "adxl345.h"
#include "rest.h"

/* The argument of the reply to a measuring command. */
typedef enum {
    MEASURE_BEGUN, /* another reply follows */
    MEASURE_MOVED,
    MEASURE_ABORTED,  /* samples were lost, or the sensor's configuration changed */
    MEASURE_STOPPED,  /* `cal6 stop` */
    MEASURE_POSITION, /* from here on see calibrate.h: one of several positions; another reply follows */
    MEASURE_REPEATED, /* another reply follows */
    MEASURE_WRONG,    /* no calibration can be derived */
    MEASURE_DONE,     /* the results are valid until the reply is out */
    MEASURE_UNCHANGED /* never reported */
} measure_outcome_t;

/*
 * 256 samples each. Self-test as the data sheet asks (p. 22, 31): a rate of 100 to 800 Hz, 16 g, means over 0.1 s or
 * more before and with the force, with four samples skipped after it changes; at 400 Hz it takes 1.4 s. Noise over 2 s
 * or more: at 200, 400 and 800 Hz every second, fourth and eighth sample; its rms is within 9 % (2 / sqrt(2 x 256)) of
 * the true one in 19 of 20 cases.
 */
enum { MEASURE_SELFTEST_DHZ = 4000, MEASURE_SELFTEST_G = 16, MEASURE_SETTLE = 4 };

/* Once at start-up: nothing runs. */
void measure_reset(void);

/* Starts the measurement of this command (notice_kind_t), whose reply follows; false: another one is running. */
bool measure_start(uint8_t kind);

/* A measurement is running, or its reply is not out yet. */
bool measure_runs(void);

/* Call in every pass of the main loop, after adxl345_poll: ends what has failed, and reports what is finished. */
void measure_pass(void);

/* Takes a new sample. True: it is not for the filters. */
bool measure_sample(const int16_t lsb[3]);

/* Samples do not go to the filters. */
bool measure_borrows(void);

/* A command changes the sensor's configuration or state: a running measurement ends without a result. */
void measure_abort(void);

/* Ends cal6 if it is running; nothing is reported. */
void measure_stop(void);

/* Replaces the settings' configuration with what a measurement needs of the sensor; if it needs nothing, leaves it. */
void measure_configure(adxl345_config_t *config);

/* The sensor is to be reconfigured by measure_configure; true once for each request. */
bool measure_asks(void);

/*
 * The requested configuration is in force from the next sample on. True: it is that of the settings again, and the
 * filters, which have missed samples, must restart.
 */
bool measure_configured(void);

/* The readings of the last rest, valid with MEASURE_DONE. */
const rest_t *measure_rest(void);

/* Their mean by axis, LSB in Q4, valid with MEASURE_DONE; of a self-test the change that the force has made. */
int16_t measure_result_lsb_q4(uint8_t axis);

#endif
