/*
 * The application: start-up, one pass of the main loop, and what the commands do. Main only.
 * main.c calls app_start once and app_pass for ever; the host build and the tests do the same.
 */
#ifndef APP_H
#define APP_H

#include <stdbool.h>
#include <stdint.h>

void app_start(void);

/* The watchdog brought so many resets in a row that this run began at the lowest rate, and it has not lasted yet. */
bool app_is_safe(void);

/* Does all the work there is, then sleeps until there is more. */
void app_pass(void);

/*
 * Settings. APP_ILLEGAL: nothing changed, not a legal value. Rate, range and filter take effect without losing a
 * sample. A filter that does not fit the sample period (settings_fit) is refused as is a rate that is too fast for the
 * filter.
 */
typedef enum { APP_ILLEGAL, APP_DONE, APP_TOO_SLOW } app_answer_t;
app_answer_t app_set_filter(uint8_t filter_kind);
app_answer_t app_set_rate(uint16_t rate_dhz);
app_answer_t app_set_range(uint16_t range_g);
app_answer_t app_set_every(uint16_t every);
app_answer_t app_set_baud(uint32_t baud);
void app_set_mode(uint8_t mode);

/* Sampling off (sensor in standby) and on. */
void app_stop(void);
void app_go(void);

/* False while the banner goes out and while the line drains before its rate changes: bytes wait in the receive ring. */
bool app_takes_commands(void);

#endif
