/* Who has checked in since the last feed. */
#include "health.h"

#include <stdbool.h>

#include "adxl345.h"
#include "hal_time.h"
#include "hal_uart.h"
#include "hal_watchdog.h"
#include "hang_test.h"

/* A poll at the deadline moves it; one that finds it this long past shows that the driver does not. */
#define POLL_GRACE_US 20000ul

#if HANG_TEST
volatile uint8_t hang_stages;
#endif

static uint8_t checked_in;
static uint8_t tx_sent_seen;
static uint32_t pause_until_us;
static bool paused;
static bool polled;

void health_start(void)
{
    checked_in = 0;
    paused = false;
    polled = false;
    tx_sent_seen = hal_uart_tx_sent();
    hal_watchdog_start();
}

void health_driver_polled(void)
{
    polled = true;
}

static void look_at_sampling(uint32_t now_us)
{
    if (!polled) {
        return;
    }
    polled = false;
    bool stopped = adxl345_phase() == ADXL345_STOPPED;
    if (stopped || !hal_time_reached(now_us, adxl345_deadline_us() + POLL_GRACE_US)) {
        checked_in |= HEALTH_SAMPLING;
    }
}

void health_sample_filtered(void)
{
    checked_in |= HEALTH_FILTERING;
}

void health_pause_filtering(uint32_t until_us)
{
    pause_until_us = until_us;
    paused = true;
}

void health_resume_filtering(void)
{
    paused = false;
}

static void look_at_filtering(uint32_t now_us)
{
    if (paused && hal_time_reached(now_us, pause_until_us)) {
        paused = false;
    }
    if (paused || adxl345_queued() == 0) {
        checked_in |= HEALTH_FILTERING;
    }
}

static void look_at_output(void)
{
    uint8_t sent = hal_uart_tx_sent();
    if (sent != tx_sent_seen || hal_uart_tx_idle()) {
        tx_sent_seen = sent;
        checked_in |= HEALTH_OUTPUT;
    }
}

void health_pass(uint32_t now_us)
{
    look_at_sampling(now_us);
    look_at_filtering(now_us);
    look_at_output();
    if (checked_in == HEALTH_ALL) {
        hal_watchdog_feed();
        checked_in = 0;
    }
    hal_watchdog_note((uint8_t)(HEALTH_ALL & (uint8_t)~checked_in));
}
