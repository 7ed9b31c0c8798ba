/*
 * Any bytes typed to the whole firmware on virtual time. Each line gets the replies that docs/protocol.md gives it, in
 * order (exact while the receive ring lost nothing); settings are legal at any time and at the end those that were
 * asked for; every line sent keeps the protocol's grammar.
 *
 * Input: an options byte, then bytes as typed; 0 is a pause of 40 ms.
 */
#include <string.h>

#include "adxl345_registers.h"
#include "app/app.h"
#include "base/counters.h"
#include "base/notices.h"
#include "control/control.h"
#include "fuzz.h"
#include "fuzz_commands.h"
#include "hal_host.h"
#include "hal_uart.h"
#include "settings/settings.h"
#include "settings/store.h"

enum {
    OPTION_NO_SENSOR = 1,
    OPTION_NEAR_WRAP = 2,
    OPTION_DAMAGED_BYTES = 4, /* a framing error in every 16th byte */
    TYPED_MAX = 400,
    STREAM_ROWS = 50,
    BANNER_LIMIT_MS = 2000,
    SETTLE_LIMIT_MS = 300000
};

static stream_t stream;
static stream_row_t rows[STREAM_ROWS];
static said_t said;
static char line[400];
static size_t line_length;
static bool in_banner;

static void on_tx(uint8_t byte)
{
    if (byte != '\n') {
        FUZZ_CHECK(line_length < sizeof line - 1, "a line without end");
        line[line_length++] = (char)byte;
        return;
    }
    line[line_length] = '\0';
    line_length = 0;
    if (said_line(&said, line) && !in_banner) {
        said_reply(&said, line);
    }
}

/* x, y, z that change, so that neither filters nor rows stand still; the third axis clips now and then. */
static void make_stream(void)
{
    for (size_t i = 0; i < STREAM_ROWS; i++) {
        int16_t swing = (int16_t)((i * 37) % 23);
        rows[i] = (stream_row_t){
            .t_us = i * 10000, .lsb = { (int16_t)(31 - swing), (int16_t)(swing * swing - 53), i == 30 ? 4095 : 248 }
        };
    }
    stream = (stream_t){ .rows = rows, .count = STREAM_ROWS, .rate_hz = 100.0 };
}

static void check_settings(void)
{
    FUZZ_CHECK(settings_legal(settings()), "settings: filter %u rate %u range %u every %u baud %lu mode %u",
               settings()->choice.filter, settings()->rate_dhz, settings()->range_g, settings()->every,
               (unsigned long)settings()->baud, settings()->mode);
}

static void pass(void)
{
    app_pass();
    check_settings();
    said.faults_expected = said.faults_expected || settings()->address == ADXL345_ADDRESS_HIGH;
    FUZZ_CHECK(hal_host_watchdog_bite() == 0, "the watchdog bites at %.1f ms", hal_host_now_ms());
}

static void run_ms(double ms)
{
    for (double end_ms = hal_host_now_ms() + ms; hal_host_now_ms() < end_ms;) {
        pass();
    }
}

static bool quiet(void)
{
    return notices_empty() && !control_line_waits() && !store_busy();
}

/* A pass takes one line at most and may sleep before; the ring holds 64 blank ones. */
#define READ_LIMIT_MS 300.0

/* Until nothing is under way: bytes, replies, a change of the line rate; and what the ring held has gone out. */
static void settle(void)
{
    double quiet_ms = READ_LIMIT_MS + 257e4 / (double)settings()->baud;
    double limit_ms = hal_host_now_ms() + SETTLE_LIMIT_MS;
    for (double quiet_since_ms = hal_host_now_ms(); hal_host_now_ms() < quiet_since_ms + quiet_ms;) {
        pass();
        if (!quiet()) {
            quiet_since_ms = hal_host_now_ms();
            quiet_ms = READ_LIMIT_MS + 257e4 / (double)settings()->baud;
        }
        FUZZ_CHECK(hal_host_now_ms() < limit_ms, "the replies do not end");
    }
}

/* At the slowest rate if the line may get slower meanwhile. */
static void type(const char *text)
{
    size_t length = strlen(text);
    bool may_slow_down = strpbrk(text, "bB") != NULL || !quiet();
    double byte_ms = may_slow_down ? 1.05 : 1.05e4 / (double)hal_host_baud();
    hal_host_type(text);
    run_ms((double)length * byte_ms);
}

static void type_all(fuzz_input_t *in, expected_t *expected)
{
    char chunk[TYPED_MAX + 1];
    size_t length = 0;
    for (unsigned typed = 0; fuzz_more(in) && typed < TYPED_MAX; typed++) {
        char byte = (char)fuzz_u8(in);
        if (byte == '\0') {
            chunk[length] = '\0';
            type(chunk);
            run_ms(40);
            length = 0;
            continue;
        }
        chunk[length++] = byte;
        expected_byte(expected, (uint8_t)byte);
    }
    chunk[length] = '\0';
    type(chunk);
}

static void start(uint8_t options)
{
    hal_host_config_t config = { .time_start_us = options & OPTION_NEAR_WRAP ? 0xFFFFFFFFu - 150000u : 0,
                                 .on_tx = on_tx };
    fuzz_reset_memory();
    make_stream();
    memset(&said, 0, sizeof said);
    said.faults_expected = (options & OPTION_NO_SENSOR) != 0;
    line_length = 0;
    in_banner = true;
    hal_host_begin(&config, &stream, true);
    if (options & OPTION_NO_SENSOR) {
        adxl345_model_power(hal_host_sensor(), false);
    }
    app_start();
    while (!quiet()) {
        pass();
        FUZZ_CHECK(hal_host_now_ms() < BANNER_LIMIT_MS, "the banner does not end");
    }
    run_ms(20); /* the last line of the banner is on its way yet */
    in_banner = false;
    FUZZ_CHECK(said.banner_lines == 7, "a banner of %u lines", said.banner_lines);
    hal_host_faults()->corrupt_rx_every = options & OPTION_DAMAGED_BYTES ? 16 : 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input_t in = { data, size, 0 };
    expected_t expected;
    expected_begin(&expected);
    start(fuzz_u8(&in));
    type_all(&in, &expected);
    settle();
    if (expected.measures) {
        return 0; /* nobody knows when it answers; what every pass checks holds */
    }
    if (hal_uart_rx_lost() == 0) {
        check_replies(&said, &expected);
        FUZZ_CHECK(settings_equal(settings(), &expected.settings),
                   "settings are not what was typed: rate %u every %u baud %lu", settings()->rate_dhz,
                   settings()->every, (unsigned long)settings()->baud);
        FUZZ_CHECK(counted(COUNT_DROPPED) == 0 || expected.baud_changed, "%u rows dropped",
                   (unsigned)counted(COUNT_DROPPED));
    } else {
        FUZZ_CHECK(count_replies(&said) <= expected.line_ends, "%u replies to %u lines", count_replies(&said),
                   expected.line_ends);
    }
    return 0;
}
