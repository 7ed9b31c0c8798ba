#include "support/rig.h"

#include <string.h>

#include "adxl345_burst.h"
#include "hal_drdy.h"
#include "hal_sleep.h"
#include "hal_time.h"
#include "hal_uart.h"
#include "support/board.h"
#include "unity.h"

enum { ROWS = 4000, STAMP_LIMIT_US = 100 };

rig_t rig;

static uint32_t start_us;
static int16_t latched[ROWS][3];
static uint32_t latched_us[ROWS]; /* by the driver's clock */

static void on_latched(uint64_t t_us, size_t row, const int16_t lsb[3])
{
    (void)row;
    if (rig.latched_count < ROWS) {
        memcpy(latched[rig.latched_count], lsb, sizeof latched[0]);
        latched_us[rig.latched_count] = start_us + (uint32_t)t_us;
    }
    rig.latched_count++;
}

void rig_begin(double rate_hz, hal_host_config_t config)
{
    stream_free(&rig.stream);
    rig = (rig_t){ .limit_us = STAMP_LIMIT_US, .pass = rig_pass };
    rig.stream = board_constant_stream(ROWS, rate_hz, 0, -100, 250);
    for (size_t i = 0; i < rig.stream.count; i++) {
        rig.stream.rows[i].lsb[0] = (int16_t)i;
    }
    start_us = config.time_start_us;
    config.on_latched = on_latched;
    hal_host_begin(&config, &rig.stream, false);
    rig_reset();
}

void rig_reset(void)
{
    hal_uart_init(115200);
    hal_time_init();
    hal_drdy_enable();
    adxl345_init();
}

/* Which latched sample this is, of those after the last that was taken. */
static size_t latched_with(const int16_t lsb[3])
{
    size_t known = rig.latched_count < ROWS ? rig.latched_count : ROWS;
    size_t at = rig.next;
    while (at < known && memcmp(latched[at], lsb, sizeof latched[0]) != 0) {
        at++;
    }
    TEST_ASSERT_TRUE_MESSAGE(at < known, "a sample came twice, or the sensor never held it");
    return at;
}

static void check(const adxl345_sample_t *sample)
{
    size_t at = latched_with(sample->lsb);
    int32_t late_us = (int32_t)(sample->t_us - latched_us[at]);
    uint32_t off_us = (uint32_t)(late_us < 0 ? -late_us : late_us);
    TEST_ASSERT_TRUE_MESSAGE(off_us <= rig.limit_us, "the time of another sample");
    rig.off_us = off_us > rig.off_us ? off_us : rig.off_us;
    rig.next = at + 1;
    rig.last_x = sample->lsb[0];
}

void rig_take_all(void)
{
    const adxl345_sample_t *sample;
    while (!rig.leaves && (sample = adxl345_take()) != NULL) {
        check(sample);
        rig.taken_count++;
        hal_wake();
    }
}

void rig_pass(void)
{
    adxl345_poll(hal_time_us());
    rig_take_all();
    board_driver_sleep();
}

void rig_run_ms(double ms)
{
    for (double end_ms = hal_host_now_ms() + ms; hal_host_now_ms() < end_ms;) {
        rig.pass();
    }
}

void rig_stream_ms(const adxl345_config_t *config, double ms)
{
    adxl345_start(config);
    rig_run_ms(ms);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
}

size_t rig_lost(double ms)
{
    rig.leaves = false;
    adxl345_stop();
    rig_run_ms(ms);
    TEST_ASSERT_EQUAL(ADXL345_STOPPED, adxl345_phase());
    return rig.latched_count - rig.taken_count;
}

void rig_away(unsigned passes)
{
    while (passes-- != 0) {
        hal_wake();
        board_driver_sleep();
    }
}

void rig_until_burst(void)
{
    while (!adxl345_burst_running()) {
        adxl345_poll(hal_time_us());
        rig_away(1);
    }
}

void rig_until_pause(void)
{
    while (hal_drdy_high() || adxl345_burst_running()) {
        rig_run_ms(0.1);
    }
}

void rig_edges(unsigned count)
{
    while (count-- != 0) {
        hal_host_drdy_edge();
    }
}

void rig_until_taken(size_t count)
{
    for (double end_ms = hal_host_now_ms() + 1000.0; rig.taken_count < count;) {
        TEST_ASSERT_TRUE(hal_host_now_ms() < end_ms);
        rig_pass();
    }
}

void rig_until_asked(void)
{
    hal_host_faults()->int1_cut = true;
    while (adxl345_burst_running()) {
        rig_pass();
    }
    for (double end_ms = hal_host_now_ms() + 60.0; !adxl345_burst_running();) {
        TEST_ASSERT_TRUE(hal_host_now_ms() < end_ms);
        adxl345_poll(hal_time_us());
        rig_take_all();
        if (!adxl345_burst_running()) {
            board_driver_sleep();
        }
    }
}
