/*
 * Carries out what a command or a fault causes: judges, takes and keeps settings, configures the sensor, and changes
 * the sample path once the samples of the old configuration are through. Main only.
 */
#ifndef CONTROL_H
#define CONTROL_H

#include <stdbool.h>
#include <stdint.h>

#include "settings/settings_table.h"

/* Once at start-up, after the settings are loaded: sampling starts. */
void control_start(void);

/*
 * Takes what was typed for a setting (settings_table.h) and starts what follows from it. Rate, range and filter take
 * effect without losing a sample. A filter that does not fit the sample period (settings_fit) is refused, as is a rate
 * that is too fast for the filter.
 */
setting_answer_t control_set(uint8_t which, const char *text);

/* Restores all settings as saved (settings_kept.h) or as shipped; they take effect as if set one by one. */
void control_restore(bool saved);

/*
 * Starts to save all settings while samples and rows go on; false while a measurement may change them. Take no command
 * until the save is over (store_busy).
 */
bool control_save(void);

/* Turns sampling on or off (sensor in standby). */
void control_sample(bool wanted);

/*
 * The baud rate is to change once all replies are out (they report it at the old rate). Take no command until
 * control_line_changed.
 */
bool control_line_waits(void);
void control_line_changed(void);

/*
 * Applies what has changed, and what a measurement asks for, to sensor and sample path, each as soon as the earlier
 * samples are through; true: something was applied. Call between two samples.
 */
bool control_follow(uint32_t now_us);

/*
 * Call each second: reports, once after a change has been applied, that R limits q on an axis (filter_limited); not
 * among the plotter's rows.
 */
void control_second(void);

#endif
