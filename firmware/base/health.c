/* Which stages have checked in since the last feed. */
#include "base/health.h"

#include <stdbool.h>

#include "adxl345.h"
#include "base/hang_test.h"
#include "hal_time.h"
#include "hal_uart.h"
#include "hal_watchdog.h"
#include "machine.h"

/* A poll at the deadline moves it; a deadline that is past by this much shows that the driver hangs. */
#define POLL_GRACE_US 20000ul

/*
 * After this many hangs in a row, each within ten seconds of its start, the next is to be expected: the run gets the
 * lowest rate, at which the processor has most time for everything else. Saved settings are left alone.
 */
enum { RESETS_TO_SAFE = 3 };

#if HANG_TEST
volatile uint8_t hang_stages; /* the simulator writes it by name */

volatile uint8_t *hang_stages_here(void)
{
    return &hang_stages;
}
#endif

static struct health {
    uint8_t pause_passes; /* calls of health_pass for which filtering may still pause */
    uint8_t checked_in;
    uint8_t tx_sent_seen;
    bool polled;
} health;

/* With its address in a register, each access takes half the code. */
static inline struct health *here(void)
{
    struct health *h = &health;
    MACHINE_POINTER(h);
    return h;
}

void health_start(void)
{
    struct health *h = here();
    h->checked_in = 0;
    h->pause_passes = 0;
    h->polled = false;
    h->tx_sent_seen = hal_uart_tx_sent();
    hal_watchdog_start();
}

bool health_is_safe(void)
{
    return hal_reset_repeats() >= RESETS_TO_SAFE;
}

void health_driver_polled(void)
{
    health.polled = true;
}

static void look_at_sampling(uint32_t now_us)
{
    struct health *h = here();
    if (!h->polled) {
        return;
    }
    h->polled = false;
    bool stopped = adxl345_phase() == ADXL345_STOPPED;
    if (stopped || !hal_time_reached(now_us, adxl345_deadline_us() + POLL_GRACE_US)) {
        h->checked_in |= HEALTH_SAMPLING;
    }
}

void health_sample_filtered(void)
{
    health.checked_in |= HEALTH_FILTERING;
}

void health_pause_filtering(uint8_t passes)
{
    health.pause_passes = passes;
}

static void look_at_filtering(void)
{
    struct health *h = here();
    bool paused = h->pause_passes != 0;
    if (paused) {
        h->pause_passes--;
    }
    if (paused || adxl345_queued() == 0) {
        h->checked_in |= HEALTH_FILTERING;
    }
}

static void look_at_output(void)
{
    struct health *h = here();
    uint8_t sent = hal_uart_tx_sent();
    if (sent != h->tx_sent_seen || hal_uart_tx_idle()) {
        h->tx_sent_seen = sent;
        h->checked_in |= HEALTH_OUTPUT;
    }
}

void health_pass(uint32_t now_us)
{
    look_at_sampling(now_us);
    look_at_filtering();
    look_at_output();
    if (health.checked_in == HEALTH_ALL) {
        hal_watchdog_feed();
        health.checked_in = 0;
    }
    hal_watchdog_note((uint8_t)(HEALTH_ALL & (uint8_t)~health.checked_in));
}
