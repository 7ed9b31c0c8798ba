/*
 * The application: start-up, one pass of the main loop, and what the commands do. Main only.
 * main.c calls app_start once and app_pass for ever; the host build and the tests do the same.
 */
#ifndef APP_H
#define APP_H

#include <stdbool.h>
#include <stdint.h>

#include "settings/settings_table.h"

void app_start(void);

/* The watchdog brought so many resets in a row that this run began at the lowest rate, and it has not lasted yet. */
bool app_is_safe(void);

/* Does all the work there is, then sleeps until there is more. */
void app_pass(void);

/*
 * Takes what was typed for a setting (settings_table.h) and starts what follows from it. Rate, range and filter take
 * effect without losing a sample. A filter that does not fit the sample period (settings_fit) is refused, as is a rate
 * that is too fast for the filter.
 */
setting_answer_t app_set(uint8_t which, const char *text);

/* All settings as saved (settings_kept.h), or as shipped; they take effect like each by itself. */
void app_restore(bool saved);

/* Begins to save all settings; false while sampling. Until it is over (store_busy) no command is taken. */
bool app_save(void);

/*
 * The sensor is to follow measure_configure; measure_configured is called when the samples of before are taken. anew:
 * then filters begin anew.
 */
void app_configure(bool anew);

/* Sampling on and off (sensor in standby). */
void app_sample(bool wanted);

/* False while the banner goes out and while the line drains before its rate changes: bytes wait in the receive ring. */
bool app_takes_commands(void);

#endif
