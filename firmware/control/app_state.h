/* What app.c and app_settings.c share of the application's state. Main only. */
#ifndef APP_STATE_H
#define APP_STATE_H

#include <stdbool.h>
#include <stdint.h>

/* BANNER: banner and header are going out; BAUD: the line drains before its rate changes. */
enum { STAGE_BANNER, STAGE_RUNNING, STAGE_BAUD };

/*
 * FILTER is for all samples to come, the others wait for those of the old configuration. COLD: filters begin anew.
 * MEASURE: it is told (measure_configured).
 */
enum { CHANGE_FILTER = 1, CHANGE_CONFIG = 2, CHANGE_COLD = 4, CHANGE_MEASURE = 8 };

/* What a person or the watchdog waits for is looked after so often. */
#define APP_SERVICE_US 4000u

/* Of the service, 1 s: the banner at 9600 baud takes 0.4 s; the ring at 9600 baud drains in 0.27 s. */
enum { APP_HOLD_PASSES = 250 };

typedef struct {
    uint8_t stage;
    bool sampling;   /* wanted: go or start-up, not stop */
    uint8_t changes; /* that the pipeline is to follow yet */
} app_state_t;

extern app_state_t app;

/* With the settings' configuration, or what a measurement wants. */
void app_start_sensor(void);

#endif
