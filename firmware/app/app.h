/*
 * The application: start-up and one pass of the main loop. Main only.
 * main.c calls app_start once and app_pass forever; the host build and the tests do the same.
 */
#ifndef APP_H
#define APP_H

void app_start(void);

/* Does all pending work, then sleeps until there is more. */
void app_pass(void);

#endif
