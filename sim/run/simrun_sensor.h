/* The virtual ADXL345 on the board: its clock, the feed of rows, INT1, and the file of what it served. */
#ifndef SIMRUN_SENSOR_H
#define SIMRUN_SENSOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "adxl345_model.h"
#include "simrun_judge.h"

/* samples that the judge can look back at: older ones decide nothing, and a day has 8.6 million at 100 Hz */
enum { SERVED_KEPT = 8192 };

typedef struct {
    const char *in, *served; /* NULL: none */
    bool loop, alt_address;
    double ppm;
    const adxl345_variant_t *variant;
    adxl345_part_t part;
} sensor_options_t;

extern adxl345_model_t sensor;

void sensor_start(const sensor_options_t *wanted);
/* measured: what it measures instead of a row; sampled: called after each sample. */
void sensor_hook(const int16_t *(*measured)(const int16_t lsb[3]), void (*sampled)(void));
void sensor_finish(void);
uint64_t sensor_next(void);
void sensor_step(void);
void sensor_check_rate(void);
void sensor_show_pin(void); /* drive D2 again (after a reset, or if the wire changed) */
void sensor_hold_int1(bool cut, bool high);
void sensor_disturb_int1(bool disturbed); /* the wire has the opposite of the sensor's level */
void sensor_set_clock_error(double ppm);
void sensor_restore_clock(void);               /* its own error again */
uint64_t sensor_last_tick(void);               /* cycle of the last output-data-rate tick, 0: none */
uint64_t sensor_over_at(void);                 /* cycle at which the stream ended, NEVER before that */
double sensor_period_us(void);                 /* of the last rate in force, without ppm; 0: none yet */
double sensor_true_period_us(void);            /* the same with the error of the sensor's clock */
size_t sensor_served_count(void);              /* of the whole run */
served_t *sensor_served_lately(size_t *count); /* the newest served, at least SERVED_KEPT if there were as many */
void sensor_print(FILE *json);    /* what it served, its configuration at the end, and when it last measured */
void sensor_print_mode(FILE *to); /* which feed mode was used */

#endif
