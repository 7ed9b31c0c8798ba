/* The virtual clock, interrupts, sleep, watchdog and LED of the host. */
#include "hal_host.h"

#include <string.h>

#include "hal_host_private.h"
#include "hal_irq.h"
#include "hal_led.h"
#include "hal_sleep.h"
#include "hal_strap.h"
#include "hal_time.h"
#include "hal_watchdog.h"

/* A pass of main takes time too; without it a main loop that asks to be called again would stop the clock. */
enum { CYCLES_PER_US = 16, PASS_CYCLES = 320 };

#define ALARM_RANGE_US 32768u /* of the UNO's 16-bit counter: the alarm comes again after it */

uint64_t host_now;
hal_host_config_t host_config;
hal_host_faults_t hal_host_faults;
uint32_t hal_host_cpu_hz = (uint32_t)HAL_HOST_HZ;

static bool wake_wanted;
static bool drdy_enabled;
static bool drdy_edge;
static uint64_t tick_at;
static uint64_t alarm_at;
static uint64_t watchdog_at;
static uint64_t bitten_at;
static uint8_t reset_cause;
static uint8_t note;
static uint8_t note_before;
static uint8_t repeats;
static bool led;

void hal_host_drdy_handler(void);

void hal_host_begin(const hal_host_config_t *config, const stream_t *stream, bool loop)
{
    host_config = *config;
    host_now = 0;
    hal_host_cpu_hz = (uint32_t)HAL_HOST_HZ;
    memset(&hal_host_faults, 0, sizeof hal_host_faults);
    hal_host_faults.next_status = -1;
    host_eeprom_power_on();
    host_sensor_begin(stream, loop);
    host_i2c_power_on();
    hal_host_reset_mcu(HAL_RESET_POWER_ON);
}

void hal_host_reset_mcu(uint8_t cause)
{
    wake_wanted = false;
    drdy_enabled = false;
    drdy_edge = false;
    tick_at = HOST_NEVER;
    alarm_at = HOST_NEVER;
    watchdog_at = HOST_NEVER;
    bitten_at = 0;
    reset_cause = cause;
    note_before = cause == HAL_RESET_POWER_ON ? 0 : note;
    note = 0;
    repeats = hal_reset_count((hal_reset_t)cause, true, repeats);
    host_eeprom_reset();
    led = false;
    host_i2c_begin();
    host_uart_begin();
}

uint64_t hal_host_now(void)
{
    return host_now;
}

double hal_host_now_ms(void)
{
    return (double)host_now / 16000.0;
}

uint64_t hal_host_watchdog_bite(void)
{
    return bitten_at;
}

bool hal_host_led(void)
{
    return led;
}

/* Main is never interrupted here, so there is nothing to hold off. */
uint8_t hal_irq_save(void)
{
    return 0;
}

void hal_irq_restore(uint8_t state)
{
    (void)state;
}

void hal_irq_enable(void) {}

void hal_time_init(void)
{
    tick_at = host_now + (uint64_t)HAL_TICK_US * CYCLES_PER_US;
}

uint32_t hal_time_us(void)
{
    return (uint32_t)(host_config.time_start_us + host_now / CYCLES_PER_US);
}

uint16_t hal_time_count_isr(void)
{
    return (uint16_t)hal_time_us();
}

void hal_time_stamp_isr(volatile uint32_t *t_us, uint16_t count)
{
    uint32_t now_us = hal_time_us();
    *t_us = now_us - (uint16_t)(now_us - count);
}

void hal_wake_at(uint32_t t_us)
{
    uint32_t ahead_us = (t_us - hal_time_us()) % ALARM_RANGE_US;
    uint64_t begun_at = host_now - host_now % CYCLES_PER_US; /* the microsecond that runs */
    alarm_at = begun_at + (uint64_t)(ahead_us == 0 ? ALARM_RANGE_US : ahead_us) * CYCLES_PER_US;
    if ((hal_time_us() - t_us) % ALARM_RANGE_US < HAL_WAKE_LATE_US) {
        hal_wake();
    }
}

uint8_t hal_time_lap(void)
{
    static uint8_t lap;
    lap = (uint8_t)(lap + hal_host_faults.lap_step);
    return lap;
}

void hal_drdy_enable(void)
{
    drdy_enabled = true;
}

bool hal_drdy_high(void)
{
    return hal_host_faults.int1_high || (hal_host_sensor.pin_high[1] && !hal_host_faults.int1_cut);
}

void host_drdy_changed(bool high)
{
    if (high && drdy_enabled && !hal_host_faults.int1_cut && !hal_host_faults.int1_high) {
        drdy_edge = true;
    }
}

void host_drdy_serve(void)
{
    while (drdy_edge) {
        drdy_edge = false;
        hal_host_drdy_handler();
    }
}

void hal_wake(void)
{
    wake_wanted = true;
}

static uint64_t earliest(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static void run_due_events(void)
{
    if (tick_at <= host_now) {
        tick_at += (uint64_t)HAL_TICK_US * CYCLES_PER_US;
        hal_wake();
    }
    if (alarm_at <= host_now) {
        alarm_at += (uint64_t)ALARM_RANGE_US * CYCLES_PER_US;
        hal_wake();
    }
    if (watchdog_at <= host_now && bitten_at == 0) {
        bitten_at = host_now;
    }
    if (host_sensor_next() <= host_now) {
        host_sensor_step();
    }
    if (host_i2c_next() <= host_now) {
        host_i2c_step();
    }
    if (host_uart_next() <= host_now) {
        host_uart_step();
    }
    host_drdy_serve();
}

static uint64_t next_event(void)
{
    uint64_t at = earliest(tick_at, bitten_at == 0 ? watchdog_at : HOST_NEVER);
    at = earliest(earliest(at, alarm_at), host_sensor_next());
    return earliest(at, earliest(host_i2c_next(), host_uart_next()));
}

static void go_to(uint64_t at)
{
    host_now = at > host_now ? at : host_now;
    run_due_events();
}

void hal_sleep_until_wake(void)
{
    uint64_t pass_end = host_now + PASS_CYCLES;
    while (next_event() <= pass_end) {
        go_to(next_event());
    }
    host_now = pass_end;
    while (!wake_wanted) {
        go_to(next_event());
        if (bitten_at != 0) {
            return;
        }
    }
    wake_wanted = false;
}

void hal_watchdog_start(void)
{
    hal_watchdog_feed();
}

void hal_watchdog_feed(void)
{
    watchdog_at = host_now + (uint64_t)HAL_WATCHDOG_MS * 1000u * CYCLES_PER_US;
}

void hal_watchdog_note(uint8_t new_note)
{
    note = new_note;
}

uint8_t hal_watchdog_cause(void)
{
    return reset_cause;
}

uint8_t hal_reset_note(void)
{
    return note_before;
}

uint8_t hal_reset_repeats(void)
{
    return repeats;
}

void hal_reset_settled(void)
{
    repeats = 0;
}

void hal_strap_init(void) {}

bool hal_strap_low(void)
{
    return hal_host_faults.strap_low;
}

void hal_led_init(void) {}

void hal_led_set(bool on)
{
    led = on;
}
