/*
 * Data walks one way: driver -> pipeline -> rows -> UART. Commands come back the other way through this file.
 * Before the banner and the header are out, and while the baud rate changes, samples wait in the driver's queue and in
 * the sensor's FIFO: 39 of them, 48 ms at 800 Hz.
 */
#include "app.h"

#include "adxl345.h"
#include "coast.h"
#include "commands.h"
#include "counters.h"
#include "fx.h"
#include "hal_drdy.h"
#include "hal_irq.h"
#include "hal_led.h"
#include "hal_ram.h"
#include "hal_sleep.h"
#include "hal_time.h"
#include "hal_uart.h"
#include "hal_watchdog.h"
#include "hang_test.h"
#include "health.h"
#include "pass.h"
#include "pipeline.h"
#include "replies.h"
#include "rows.h"
#include "sensor_watch.h"
#include "settings.h"
#include "silence.h"

/* The banner at 9600 baud takes 0.4 s; the ring at 9600 baud drains in 0.27 s. */
#define HOLD_LIMIT_US 1000000ul
#define SERVICE_US 4000ul
#define OVERDUE_US 20000ul /* twice HAL_TICK_US and more: passes cut for lack of time hold the service up */

/*
 * What hung so often in a row, each time within SETTLED_S of its start, hangs again: it gets the lowest rate, at which
 * the processor has most time for everything else. Settings are not kept over a reset, so there are no others to undo.
 */
enum { RESETS_TO_SAFE = 3, SETTLED_S = 10, WHOLE_LOOP = 0x80 };

/* BANNER: banner and header are going out; BAUD: the line drains before its rate changes. */
typedef enum { STAGE_BANNER, STAGE_RUNNING, STAGE_BAUD } stage_t;

/* FILTER is for all samples to come, the others wait for those of the old configuration. COLD: filters begin anew. */
enum { CHANGE_FILTER = 1, CHANGE_CONFIG = 2, CHANGE_COLD = 4 };

static uint8_t stage;
static bool sampling;    /* wanted: go or start-up, not stop */
static uint8_t changes;  /* that the pipeline is to follow yet */
static bool row_due;     /* for the sample that the pipeline has, or had last */
static uint32_t pass_us; /* time at the beginning of the pass */
static uint32_t next_second_us;
static bool look_at_rate; /* each second, where a pass has time for it */
static uint32_t next_service_us;

static void start_sensor(void)
{
    adxl345_config_t config = { settings.rate_dhz, settings.range_g, false };
    adxl345_start(&config);
}

bool app_is_safe(void)
{
    return hal_reset_repeats() >= RESETS_TO_SAFE;
}

static void forget(void)
{
    counters_start();
    replies_start();
    commands_start();
    rows_start();
    pipeline_reset();
    stage = STAGE_BANNER;
    row_due = false;
    look_at_rate = false;
    changes = 0;
}

void app_start(void)
{
    settings_defaults();
    hal_led_init();
    hal_uart_init(settings.baud);
    hal_time_init();
    hal_drdy_enable();
    adxl345_init();
    if (!HAL_RAM_CLEARED) {
        forget();
    }
    health_start();
    if (app_is_safe()) {
        settings.rate_dhz = SETTINGS_RATE_MIN_DHZ;
        settings_follow();
    }
    health_pause_filtering(hal_time_us() + HOLD_LIMIT_US);
    hal_irq_enable();
    next_service_us = hal_time_us();
    next_second_us = next_service_us + 1000000ul;
    sampling = true;
    coast_wait(next_service_us);
    pipeline_start(settings.filter, settings.rate_dhz, settings.range_g);
    (void)replies_add(REPLY_BANNER, 0);
    start_sensor();
}

app_answer_t app_set_filter(uint8_t filter_kind)
{
    if (!settings_fit(filter_kind, settings.rate_dhz)) {
        return APP_TOO_SLOW;
    }
    if (settings.filter != filter_kind) {
        settings.filter = filter_kind;
        settings_follow();
        changes |= CHANGE_FILTER;
    }
    return APP_DONE;
}

/* The pipeline follows when the driver has delivered the last sample of the old configuration. */
static void change_sensor(void)
{
    if (sampling) {
        changes |= CHANGE_CONFIG;
        start_sensor();
    }
}

app_answer_t app_set_rate(uint16_t rate_dhz)
{
    if (!settings_doubled(SETTINGS_RATE_MIN_DHZ, SETTINGS_RATE_MAX_DHZ, rate_dhz)) {
        return APP_ILLEGAL;
    }
    if (!settings_fit(settings.filter, rate_dhz)) {
        return APP_TOO_SLOW;
    }
    if (settings.rate_dhz != rate_dhz) {
        settings.rate_dhz = rate_dhz;
        settings_follow();
        change_sensor();
    }
    return APP_DONE;
}

app_answer_t app_set_range(uint16_t range_g)
{
    if (!settings_doubled(SETTINGS_RANGE_MIN_G, SETTINGS_RANGE_MAX_G, range_g)) {
        return APP_ILLEGAL;
    }
    if (settings.range_g != range_g) {
        settings.range_g = (uint8_t)range_g;
        change_sensor();
    }
    return APP_DONE;
}

app_answer_t app_set_every(uint16_t every)
{
    if (every == 0 || every > SETTINGS_EVERY_MAX) {
        return APP_ILLEGAL;
    }
    settings.every = every;
    return APP_DONE;
}

app_answer_t app_set_baud(uint32_t baud)
{
    if (!settings_baud_valid(baud)) {
        return APP_ILLEGAL;
    }
    settings.baud = baud;
    settings_follow();
    stage = STAGE_BAUD;
    health_pause_filtering(hal_time_us() + HOLD_LIMIT_US);
    return APP_DONE;
}

void app_set_mode(uint8_t mode)
{
    settings.mode = mode;
}

void app_stop(void)
{
    sampling = false;
    adxl345_stop();
}

void app_go(void)
{
    sampling = true;
    changes |= CHANGE_COLD;
    start_sensor();
}

bool app_takes_commands(void)
{
    return stage == STAGE_RUNNING;
}

static void count_seconds(uint32_t now_us)
{
    if (hal_time_reached(now_us, next_second_us)) {
        next_second_us += 1000000ul;
        count(COUNT_SECONDS);
        look_at_rate = true;
        if ((uint8_t)counters[COUNT_SECONDS] == SETTLED_S) { /* and again later: no harm */
            hal_reset_settled();
        }
    }
}

/* Begins the pipeline's change where there is one to follow. */
static bool follow_settings(void)
{
    if (changes == 0) {
        return false;
    }
    bool old_samples = adxl345_phase() == ADXL345_QUIESCING || adxl345_queued() != 0;
    uint8_t now = old_samples ? changes & CHANGE_FILTER : changes;
    changes = (uint8_t)(changes & ~now);
    if ((now & CHANGE_COLD) || ((now & CHANGE_CONFIG) && !silence_holds())) { /* else more is lost, and rows go on */
        coast_wait(pass_us);
    }
    if (now & CHANGE_COLD) {
        pipeline_start(settings.filter, settings.rate_dhz, settings.range_g);
    } else if (now != 0) {
        pipeline_change(settings.filter, settings.rate_dhz, settings.range_g);
    }
    return now != 0;
}

/* Samples are due: not while the sensor is stopped or follows a command. */
static bool sample_due(void)
{
    return adxl345_fault() != ADXL345_FAULT_NONE || adxl345_interrupted() || adxl345_phase() == ADXL345_STREAMING;
}

/* Of the sample that the pipeline has, or of one that is missing, whose place it has filled. */
static void write_row(void)
{
    row_due = false;
    if (silence_long()) {
        rows_at_once();
    } else {
        rows_sample();
    }
    health_sample_filtered();
}

/* Begins the way of one that is missing: before the oldest sample, or by now where none is on its way. */
static bool fill_gap(void)
{
    uint32_t t_us = pass_us - adxl345_lateness_us();
    bool queued = adxl345_oldest_us(&t_us);
    if (!coast_due(t_us)) {
        return false;
    }
    if (!queued && !sample_due()) {
        coast_wait(t_us);
        return false;
    }
    return (queued || !adxl345_sample_coming()) && coast_over(adxl345_period_us(), queued);
}

/* Begins the way of the next sample. One that is in the queue came before this pass. */
FX_NOINLINE bool next_sample(void)
{
    adxl345_sample_t sample;
    row_due = coast_due(pass_us) && fill_gap();
    if (!row_due) {
        if (!adxl345_take(&sample)) {
            return false;
        }
        row_due = coast_sample(sample.t_us, adxl345_period_us());
        if (row_due) {
            pipeline_sample(&sample);
        } else {
            health_sample_filtered(); /* its row is out already */
        }
    }
    pipeline_flag(adxl345_marks());
    return true;
}

/* One piece of the samples' way; false: there is nothing to do. */
static bool filter_samples(void)
{
    if (HANGS(HEALTH_FILTERING)) {
        return false;
    }
    if (pipeline_work()) {
        return true;
    }
    if (row_due) {
        write_row();
        return true;
    }
    if (look_at_rate) {
        look_at_rate = false;
        pipeline_retime(adxl345_period_us());
        return true;
    }
    return follow_settings() || next_sample();
}

/* One piece of what the stage has to do; false: nothing is left, or it waits. */
static bool stage_piece(void)
{
    switch (stage) {
    case STAGE_BANNER:
        if (!replies_empty()) {
            return false;
        }
        rows_enable(true);
        sensor_watch_start(hal_time_us());
        coast_wait(hal_time_us());
        break;
    case STAGE_BAUD:
        if (!replies_empty() || !hal_uart_tx_idle()) {
            return false;
        }
        hal_uart_init(settings.baud);
        break;
    default:
        return filter_samples();
    }
    health_resume_filtering();
    stage = STAGE_RUNNING;
    hal_wake(); /* what was typed meanwhile goes before the samples */
    return false;
}

/* What a person or the watchdog waits for need not run for every sample. */
static void service(uint32_t now_us)
{
    next_service_us = now_us + SERVICE_US;
    count_seconds(now_us);
    if (stage == STAGE_RUNNING) {
        sensor_watch_pass(now_us);
    }
    health_pass(now_us);
}

/* A row that is due and waits for a sample to be read has no moment of its own; that of a stopped driver is past. */
static void set_alarm(void)
{
    uint32_t t_us = adxl345_deadline_us();
    bool row_first = coast_due(t_us) && !coast_due(pass_us);
    hal_wake_at(row_first ? coast_due_us() : t_us);
}

/* Where something is left to do that waits for no interrupt. */
static void wake_if_work_left(void)
{
    if (row_due || changes != 0 || pipeline_changing() || adxl345_queued() != 0 || coast_due(pass_us) ||
        !replies_empty()) {
        hal_wake();
    }
}

/* Samples, replies, then the service unless it is overdue; out of time, another pass follows if there is a reason. */
void app_pass(void)
{
    pass.began = hal_time_lap();
    uint32_t now_us = hal_time_us();
    pass_us = now_us;
    if (!HANGS(HEALTH_SAMPLING)) {
        adxl345_poll(now_us);
        health_driver_polled();
    }
    while (HANGS(WHOLE_LOOP)) {
    }
    if (hal_time_reached(now_us, next_service_us + OVERDUE_US)) {
        service(now_us);
    }
    if (pass_in_time()) {
        commands_pass();
        while (stage_piece() || replies_pass()) {
            if (!pass_in_time()) {
                wake_if_work_left();
                break;
            }
        }
    } else {
        hal_wake();
    }
    if (hal_time_reached(now_us, next_service_us)) {
        if (pass_in_time()) {
            service(now_us);
        } else {
            hal_wake();
        }
    }
    set_alarm();
    hal_sleep_until_wake();
}
