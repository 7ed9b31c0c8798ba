/*
 * Data flows one way: driver -> pipeline -> rows -> UART. Commands come back the other way through this file. Until the
 * banner and the header are out, and while the baud rate changes, samples wait in the driver's queue and the sensor's
 * FIFO: 39 of them, 48 ms at 800 Hz.
 */
#include "app/app.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "adxl345.h"
#include "base/counters.h"
#include "base/hang_test.h"
#include "base/health.h"
#include "base/notices.h"
#include "base/pass.h"
#include "base/text.h"
#include "console/commands.h"
#include "console/reply_lines.h"
#include "console/speaker.h"
#include "control/control.h"
#include "control/measure.h"
#include "control/sensor_watch.h"
#include "hal_drdy.h"
#include "hal_irq.h"
#include "hal_led.h"
#include "hal_sleep.h"
#include "hal_strap.h"
#include "hal_time.h"
#include "hal_uart.h"
#include "hal_watchdog.h"
#include "machine.h"
#include "output/rows.h"
#include "path/coast.h"
#include "path/pipeline.h"
#include "path/silence.h"
#include "settings/settings.h"
#include "settings/settings_kept.h"
#include "settings/store.h"

/* A run that has lasted this long counts as stable. WHOLE_LOOP: see hang_test.h. */
enum { SETTLED_S = 10, WHOLE_LOOP = 0x80 };

static struct loop {
    uint32_t pass_us; /* time at the start of the pass */
    uint32_t next_second_us;
    uint16_t next_service_us; /* low half of the time: always less than 32 ms away */
    bool greeted;             /* banner and header are out */
    bool row_due;             /* for the sample in the pipeline, or the last one it had */
    bool look_at_rate;        /* set each second, done when a pass has time for it */
} loop;

/* With its address in a register, each access takes half the code. */
static inline struct loop *here(void)
{
    struct loop *l = &loop;
    MACHINE_POINTER(l);
    return l;
}

static void forget(void)
{
    counters_start();
    notices_start();
    reply_start();
    commands_start();
    rows_enable(false);
    measure_reset();
    pipeline_reset();
    loop.greeted = false;
    loop.row_due = false;
    loop.look_at_rate = false;
}

static void open_line(void)
{
    hal_uart_init(settings()->baud);
}

static void start_settings(void)
{
    settings_load();
    if (hal_strap_low() || health_is_safe()) {
        settings_unread();
    }
    if (health_is_safe()) {
        settings()->rate_dhz = SETTINGS_RATE_MIN_DHZ;
    }
}

void app_start(void)
{
    struct loop *l = here();
    hal_strap_init();
    hal_led_init();
    hal_time_init();
    adxl345_init();
    if (!MACHINE_RAM_CLEARED) {
        forget();
    }
    health_start();
    start_settings();
    open_line();
    text_char('\n'); /* goes out with the banner: ends a line that the reset has cut */
    health_pause_filtering(HEALTH_HOLD_PASSES);
    hal_drdy_enable(); /* last, so that no edge waits for the settings */
    hal_irq_enable();
    uint32_t now_us = hal_time_us();
    l->next_service_us = (uint16_t)now_us;
    l->next_second_us = now_us + 1000000ul;
    (void)notices_add(NOTICE_BANNER, 0);
    control_start();
}

static void count_seconds(uint32_t now_us)
{
    struct loop *l = here();
    if (hal_time_reached(now_us, l->next_second_us)) {
        l->next_second_us += 1000000ul;
        count(COUNT_SECONDS);
        l->look_at_rate = true;
        if ((uint8_t)counted(COUNT_SECONDS) == SETTLED_S) { /* true again later, which does no harm */
            hal_reset_settled();
        }
    }
}

/* Samples are expected: not while the sensor is stopped or carries out a command. */
static bool sample_due(void)
{
    return adxl345_fault() != ADXL345_FAULT_NONE || adxl345_interrupted() || adxl345_phase() == ADXL345_STREAMING;
}

/* For the sample in the pipeline, or for the missing one whose place it has filled. */
static void write_row(void)
{
    loop.row_due = false;
    rows_sample(silence_long() ? 1 : settings_every_in_force(), settings()->mode == MODE_PLOT);
    health_sample_filtered();
}

/*
 * Time from a sample being overdue to its predicted row at the earliest, us: the sample may be on the bus, or may still
 * have to be fetched by the clock.
 */
#define READ_LATE_US 2000u

/* Starts on a missing sample: one due before the oldest queued sample, or by the current time if none is on its way. */
static bool fill_gap(void)
{
    uint32_t t_us = loop.pass_us - READ_LATE_US;
    bool queued = adxl345_oldest_us(&t_us);
    if (!coast_due(t_us)) {
        return false;
    }
    if (!queued && !sample_due()) {
        coast_wait(t_us);
        return false;
    }
    return (queued || !adxl345_sample_waits()) && coast_over(adxl345_period_us(), queued);
}

/* Starts on the next sample. A sample in the queue came before this pass. */
static bool next_sample(void)
{
    if (measure_borrows()) {
        coast_wait(loop.pass_us);
    }
    loop.row_due = coast_due(loop.pass_us) && fill_gap();
    if (!loop.row_due) {
        const adxl345_sample_t *sample = adxl345_take();
        if (sample == NULL) {
            return false;
        }
        hal_wake_at(loop.pass_us - HAL_WAKE_LATE_US); /* the alarm for this sample would otherwise cause another pass */
        if (measure_sample(sample->lsb)) {
            health_sample_filtered();
            return true;
        }
        loop.row_due = coast_sample(sample->t_us, adxl345_period_us());
        if (loop.row_due) {
            pipeline_sample(sample);
        } else {
            health_sample_filtered(); /* its row is already out */
        }
    }
    pipeline_flag(adxl345_marks());
    return true;
}

/* One piece of the sample path's work; false: there is nothing to do. */
static bool filter_samples(void)
{
    if (HANGS(HEALTH_FILTERING)) {
        return false;
    }
    if (pipeline_work()) {
        return true;
    }
    if (loop.row_due) {
        write_row();
        return true;
    }
    if (loop.look_at_rate) {
        loop.look_at_rate = false;
        pipeline_second(adxl345_period_us());
        sensor_watch_second();
        control_second();
        return true;
    }
    return control_follow(loop.pass_us) || next_sample();
}

/* Rows and filtering start or resume; what was typed meanwhile comes before the samples. */
static void go_on(void)
{
    health_pause_filtering(0);
    hal_wake();
}

/* One piece of work; false: nothing is left, or it has to wait. */
static bool work_piece(void)
{
    if (!loop.greeted) {
        if (notices_empty()) {
            loop.greeted = true;
            rows_enable(true);
            coast_wait(hal_time_us());
            go_on();
        }
        return false;
    }
    if (control_line_waits()) {
        if (notices_empty() && hal_uart_tx_idle()) {
            open_line();
            control_line_changed();
            go_on();
        }
        return false;
    }
    return filter_samples();
}

/* What only a person or the watchdog waits for need not run for every sample. */
static void service(uint32_t now_us)
{
    struct loop *l = here();
    l->next_service_us = (uint16_t)(now_us + HEALTH_PASS_US);
    count_seconds(now_us);
    if (loop.greeted && !control_line_waits()) {
        sensor_watch_pass(now_us);
    }
    health_pass(now_us);
}

/*
 * A row that is due and waits for a sample to be read needs no alarm of its own. A time further ahead than the alarm
 * can distinguish from the past is checked again on the way; so is the deadline of a stopped driver, which is past.
 */
static void set_alarm(void)
{
    struct loop *l = here();
    uint32_t t_us = adxl345_deadline_us();
    uint32_t row_us = coast_due_us() + READ_LATE_US;
    if (hal_time_reached(t_us, row_us) && !hal_time_reached(l->pass_us, row_us)) {
        t_us = row_us;
    }
    if (t_us - l->pass_us > HAL_WAKE_AHEAD_US) {
        t_us = l->pass_us + HAL_WAKE_AHEAD_US;
    }
    hal_wake_at(t_us);
}

/*
 * Bytes stay in the receive ring while the banner goes out, while the baud rate changes, and until the result of a save
 * is reported.
 */
static bool takes_commands(void)
{
    return loop.greeted && !control_line_waits() && !notices_hold(NOTICE_SAVED, NOTICE_SAVED);
}

/* Commands, samples, replies, while the pass has time; if time runs out, another pass follows. */
static void serve(void)
{
    if (pass_in_time() && !(takes_commands() && commands_pass() && !pass_in_time())) {
        do {
            if (!work_piece() && !speaker_pass()) {
                return;
            }
        } while (pass_in_time());
    }
    hal_wake();
}

void app_pass(void)
{
    pass_begin();
    uint32_t now_us = hal_time_us();
    loop.pass_us = now_us;
    if ((int16_t)(uint16_t)((uint16_t)now_us - loop.next_service_us) >= 0) {
        service(now_us); /* before the poll: no unfiltered sample has come yet */
    }
    if (!HANGS(HEALTH_SAMPLING)) {
        adxl345_poll(now_us);
        health_driver_polled();
    }
    while (HANGS(WHOLE_LOOP)) {
    }
    measure_pass();
    serve();
    if (store_busy()) {
        (void)store_pass();
        hal_wake();
    }
    set_alarm();
    hal_sleep_until_wake();
}
