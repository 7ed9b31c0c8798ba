/*
 * The driver on the virtual sensor and bus: arbitrary register contents at the start, then any sequence of starts,
 * stops, stalls of main, broken wires, foreign bus states, lost writes, power cycles and changed registers. The queue
 * keeps its bounds, the deadline that the watchdog looks at never passes unnoticed, what is stopped has no fault, no
 * sample comes out that the sensor did not hold, and once the faults end, samples come, complete and in order, within
 * RECOVERY_MS and RECOVERY_PERIODS.
 *
 * Input: a byte of options, registers (number, then address and value each), then operations of two bytes.
 */
#include <string.h>

#include "adxl345.h"
#include "adxl345_burst.h"
#include "adxl345_registers.h"
#include "fuzz.h"
#include "hal_drdy.h"
#include "hal_host.h"
#include "hal_i2c.h"
#include "hal_sleep.h"
#include "hal_time.h"
#include "hal_uart.h"

enum { LATCHED_MAX = 60000, STREAM_ROWS = 4000, REGISTERS_MAX = 8, OPERATIONS_MAX = 120 };

/*
 * The longest way back, from the limits in lib/adxl345/src/adxl345.c. Drain that lasts 100 ms; probe and configuration,
 * 21 accesses, 6 ms; first sample awaited 20 ms and 3 periods; the sensor asked, 3 ms; back-off 25 ms; probe at the
 * other address and configuration again, 7 ms; first sample after 1.1 ms and 2 periods.
 */
#define RECOVERY_MS 165.0
#define RECOVERY_PERIODS 5.0
#define TRUST_PERIODS 36.0
/* health.c lets the dog bite when a deadline has passed for longer. */
#define POLL_GRACE_US 20000u

static const uint16_t rates_dhz[] = { 125, 250, 500, 1000, 2000, 4000, 8000 };
static const uint8_t ranges_g[] = { 2, 4, 8, 16 };

static stream_t stream;
static stream_row_t stream_rows[STREAM_ROWS];
static int16_t latched[LATCHED_MAX][3];
static size_t latched_count;
static size_t latched_at; /* all before were delivered or skipped */
static size_t delivered;
static uint32_t last_us;
static bool in_order; /* since the last start, no changed register: samples come in the order of the sensor */
static bool running;  /* asked for, not stopped */
static adxl345_config_t config;

static void on_latched(uint64_t t_us, size_t row, const int16_t lsb[3])
{
    (void)t_us;
    (void)row;
    FUZZ_CHECK(latched_count < LATCHED_MAX, "more samples than this target holds");
    memcpy(latched[latched_count++], lsb, sizeof latched[0]);
}

/*
 * x counts, y and z differ too: every sample tells which one it is. x stays below its rail at 2 g with the 522 LSB that
 * the self-test adds, where y and z do not: all three at their rails would be a sensor that is stuck.
 */
static void make_stream(void)
{
    for (size_t i = 0; i < STREAM_ROWS; i++) {
        stream_rows[i] = (stream_row_t){
            .t_us = i * 10000, .lsb = { (int16_t)(i % 480 - 500), (int16_t)(i / 480 - 100), (int16_t)(i % 7 + 250) }
        };
    }
    stream = (stream_t){ .rows = stream_rows, .count = STREAM_ROWS, .rate_hz = 100.0 };
}

static bool held(const adxl345_sample_t *sample, size_t from)
{
    for (size_t i = from; i < latched_count; i++) {
        if (memcmp(latched[i], sample->lsb, sizeof latched[i]) == 0) {
            latched_at = in_order ? i + 1 : latched_at;
            return true;
        }
    }
    return false;
}

/* A sensor with changed registers may show a sample again, or its empty output: only then order is not asked for. */
static void check_sample(const adxl345_sample_t *sample)
{
    static const int16_t empty[3];
    delivered++;
    last_us = sample->t_us;
    if (held(sample, in_order ? latched_at : 0)) {
        return;
    }
    bool empty_shown = !in_order && memcmp(sample->lsb, empty, sizeof empty) == 0;
    FUZZ_CHECK(empty_shown, "at %.1f ms the sample %d, %d, %d, which the sensor did not hold", hal_host_now_ms(),
               sample->lsb[0], sample->lsb[1], sample->lsb[2]);
}

static void poll(void)
{
    uint32_t now_us = hal_time_us();
    adxl345_poll(now_us);
    FUZZ_CHECK(adxl345_phase() != ADXL345_STOPPED || adxl345_fault() == ADXL345_FAULT_NONE, "stopped with fault %d",
               (int)adxl345_fault());
    FUZZ_CHECK(adxl345_queued() < ADXL345_QUEUE_LENGTH, "%u samples queued", adxl345_queued());
    if (adxl345_phase() != ADXL345_STOPPED && !hal_i2c_stop_pending()) { /* which is polled until it has ended */
        uint32_t deadline_us = adxl345_deadline_us();
        FUZZ_CHECK(!hal_time_reached(now_us, deadline_us + POLL_GRACE_US),
                   "stuck: phase %d, the deadline passed %lu us ago", (int)adxl345_phase(),
                   (unsigned long)(now_us - deadline_us));
    }
}

static void run_ms(double ms, bool take)
{
    const adxl345_sample_t *sample;
    for (double end_ms = hal_host_now_ms() + ms; hal_host_now_ms() < end_ms;) {
        poll();
        while (take && (sample = adxl345_take()) != NULL) {
            check_sample(sample);
            hal_wake(); /* a slot is free: the driver may go on, as in firmware/app/app.c */
        }
        hal_sleep_until_wake();
    }
}

/*
 * Main does something else: interrupts run, nobody polls. Its own first poll after that is late through no fault of the
 * driver.
 */
static void stall_ms(double ms)
{
    for (double end_ms = hal_host_now_ms() + ms; hal_host_now_ms() < end_ms;) {
        hal_sleep_until_wake();
    }
    adxl345_poll(hal_time_us());
}

static void write_register(uint8_t reg, uint8_t value)
{
    (void)adxl345_model_start(hal_host_sensor(), (uint8_t)(hal_host_sensor()->address << 1));
    (void)adxl345_model_write(hal_host_sensor(), reg);
    (void)adxl345_model_write(hal_host_sensor(), value);
    adxl345_model_stop(hal_host_sensor());
}

static void set_power(bool on)
{
    adxl345_model_power(hal_host_sensor(), on);
}

static void start(uint8_t choice)
{
    config = (adxl345_config_t){ rates_dhz[choice % 7], ranges_g[choice / 7 % 4], choice / 28 % 2 != 0, 0 };
    adxl345_start(&config);
    running = true;
}

/*
 * States that no transfer of ours can mean; the others would say that a byte was acknowledged which the sensor never
 * saw.
 */
static int foreign_status(uint8_t choice)
{
    static const uint8_t status[] = { 0x00, 0x20, 0x30, 0x38, 0x48, 0x60, 0x68, 0x70, 0x78, 0x80, 0x88,
                                      0x90, 0x98, 0xA0, 0xA8, 0xB0, 0xB8, 0xC0, 0xC8, 0xD0, 0xE0, 0xF8 };
    return status[choice % sizeof status];
}

static void change_register(uint8_t reg, uint8_t value)
{
    if (!adxl345_burst_running()) { /* not in the middle of a transfer: the model has one bus */
        in_order = false;
        write_register(reg, value);
    }
}

static void operate(fuzz_input_t *in)
{
    static const uint8_t lost[] = { ADXL345_BW_RATE,  ADXL345_POWER_CTL, ADXL345_INT_ENABLE, ADXL345_DATA_FORMAT,
                                    ADXL345_FIFO_CTL, ADXL345_INT_MAP,   ADXL345_OFSX,       0 };
    uint8_t operation = fuzz_u8(in);
    uint8_t value = fuzz_u8(in);
    switch (operation % 16) {
    case 4:
        stall_ms(value * 0.5);
        break;
    case 5:
        run_ms(value * 0.5, false);
        break;
    case 6:
        hal_host_faults()->scl_low = (value & 1) != 0;
        hal_host_faults()->sda_low = (value & 2) != 0;
        hal_host_faults()->stop_stuck = (value & 4) != 0;
        break;
    case 7:
        hal_host_faults()->hang_clocks = value % 40;
        break;
    case 8:
        hal_host_faults()->int1_cut = (value & 1) != 0;
        hal_host_faults()->int1_high = (value & 2) != 0;
        break;
    case 9:
        hal_host_faults()->write_lost_register = lost[value % sizeof lost];
        break;
    case 10:
        hal_host_faults()->id_wrong = (value & 1) != 0;
        break;
    case 11:
        hal_host_faults()->next_status = foreign_status(value);
        hal_host_faults()->status_skip = operation / 16u;
        break;
    case 12:
        set_power((value & 1) != 0);
        break;
    case 13:
        change_register((uint8_t)(ADXL345_OFSX + operation / 16u * 2u + (value & 1u)), value);
        break;
    case 14:
        start(value);
        break;
    case 15:
        adxl345_stop();
        running = false;
        break;
    default:
        run_ms(value * 0.25, true);
        break;
    }
}

static void end_faults(void)
{
    *hal_host_faults() = (hal_host_faults_t){ .next_status = -1 };
    if (!in_order || !hal_host_sensor()->powered) {
        set_power(false);
        set_power(true);
    }
    if (!running) {
        start(3);
    }
}

/* Until the sensor holds no sample that is still to come. */
static void empty_all(void)
{
    double limit_ms = hal_host_now_ms() + 50.0;
    while (hal_drdy_high() || adxl345_burst_running() || adxl345_queued() != 0) {
        run_ms(0.05, true);
        FUZZ_CHECK(hal_host_now_ms() < limit_ms, "the sensor is never empty");
    }
    latched_at = latched_count;
    in_order = true;
}

static void check_recovery(void)
{
    end_faults();
    double period_ms = 10000.0 / config.rate_dhz;
    run_ms(RECOVERY_MS + RECOVERY_PERIODS * period_ms, true);
    if (adxl345_fault() == ADXL345_FAULT_INT1_STUCK) { /* samples come; the wire is trusted after 32 good ones */
        run_ms(TRUST_PERIODS * period_ms, true);
    }
    FUZZ_CHECK(adxl345_phase() == ADXL345_STREAMING && adxl345_fault() == ADXL345_FAULT_NONE,
               "%.0f ms after the faults: phase %d, fault %d", RECOVERY_MS + RECOVERY_PERIODS * period_ms,
               (int)adxl345_phase(), (int)adxl345_fault());
    empty_all();
    size_t first = latched_count;
    size_t taken = delivered;
    uint32_t began_us = last_us;
    run_ms(4.0 * period_ms, true);
    stall_ms(period_ms * 20.0 < 200.0 ? period_ms * 20.0 : 200.0); /* up to 32 samples wait, queue and FIFO hold 39 */
    run_ms(8.0 * period_ms + 20.0, true);
    adxl345_stop();
    run_ms(120.0, true);
    FUZZ_CHECK(delivered - taken == latched_count - first, "%zu samples delivered of %zu", delivered - taken,
               latched_count - first);
    double mean_us = (double)(last_us - began_us) / (double)(delivered - taken);
    FUZZ_CHECK(mean_us > period_ms * 900.0 && mean_us < period_ms * 1100.0, "samples every %.0f us", mean_us);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input_t in = { data, size, 0 };
    uint8_t options = fuzz_u8(&in);
    hal_host_config_t host = { .time_start_us = options & 1 ? 0xFFFFFFFFu - 200000u : 0, .on_latched = on_latched };
    fuzz_reset_memory();
    make_stream();
    latched_count = 0;
    latched_at = 0;
    delivered = 0;
    last_us = 0;
    in_order = true;
    hal_host_begin(&host, &stream, true);
    hal_host_sensor()->address = options & 2 ? ADXL345_ADDRESS_HIGH : ADXL345_ADDRESS_LOW;
    for (unsigned i = fuzz_u8(&in) % REGISTERS_MAX; i != 0; i--) {
        uint8_t reg = fuzz_u8(&in);
        write_register((uint8_t)(ADXL345_THRESH_TAP + reg % 29), fuzz_u8(&in));
    }
    hal_uart_init(115200);
    hal_time_init();
    hal_drdy_enable();
    adxl345_init();
    start(options >> 2);
    for (unsigned i = 0; i < OPERATIONS_MAX && fuzz_more(&in); i++) {
        operate(&in);
    }
    check_recovery();
    return 0;
}
