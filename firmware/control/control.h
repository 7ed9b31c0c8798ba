/*
 * What a command or a fault causes: settings judged, taken and kept, the sensor configured, the sample path told when
 * the samples of the old configuration are through. Main only.
 */
#ifndef CONTROL_H
#define CONTROL_H

#include <stdbool.h>
#include <stdint.h>

#include "settings/settings_table.h"

/* Once at start-up, when the settings are known: sampling begins. */
void control_start(uint32_t now_us);

/*
 * Takes what was typed for a setting (settings_table.h) and starts what follows from it. Rate, range and filter take
 * effect without losing a sample. A filter that does not fit the sample period (settings_fit) is refused, as is a rate
 * that is too fast for the filter.
 */
setting_answer_t control_set(uint8_t which, const char *text);

/* All settings as saved (settings_kept.h), or as shipped; they take effect like each by itself. */
void control_restore(bool saved);

/*
 * Begins to save all settings while samples and rows go on; false while a measurement may change them. Until it is over
 * (store_busy) no command is to be taken.
 */
bool control_save(void);

/* Sampling on and off (sensor in standby). */
void control_sample(bool wanted);

/*
 * The baud rate is to change, when all replies are out (they report it at the old one). Until control_line_changed no
 * command is to be taken.
 */
bool control_line_waits(void);
void control_line_changed(void);

/*
 * What has changed and what a measurement asks for takes effect on sensor and sample path, each as soon as the samples
 * of before are through; true: something did. Between two samples.
 */
bool control_follow(uint32_t now_us);

#endif
