/*
 * The host's board: its parts, what power-on and a reset do to them, and the parts that take only a few lines: the
 * timer's tick and alarm, the watchdog, the LED, the strap.
 */
#include "hal_host.h"

#include "hal_host_private.h"
#include "hal_irq.h"
#include "hal_led.h"
#include "hal_sleep.h"
#include "hal_strap.h"
#include "hal_time.h"
#include "hal_watchdog.h"

#define ALARM_RANGE_US 32768u /* of the UNO's 16-bit counter: the alarm repeats after it */

static uint32_t cpu_hz = (uint32_t)HAL_HOST_HZ;
static uint64_t tick_at;
static uint64_t alarm_at;
static uint64_t watchdog_at;
static uint64_t bitten_at;
static uint8_t reset_cause;
static uint8_t note;
static uint8_t note_before;
static uint8_t repeats;
static bool led;
static bool led_is_output;
static bool strap_pulled_up;

static uint64_t tick_next(void)
{
    return tick_at;
}

static void tick_step(void)
{
    tick_at += (uint64_t)HAL_TICK_US * HOST_CYCLES_PER_US;
    host_drdy_tick();
    hal_wake();
}

static uint64_t alarm_next(void)
{
    return alarm_at;
}

static void alarm_step(void)
{
    alarm_at += (uint64_t)ALARM_RANGE_US * HOST_CYCLES_PER_US;
    hal_wake();
}

static uint64_t watchdog_next(void)
{
    return bitten_at == 0 ? watchdog_at : HOST_NEVER;
}

static void watchdog_step(void)
{
    bitten_at = hal_host_now();
    host_clock_stop();
}

static const host_part_t parts[] = {
    { tick_next, tick_step },         { alarm_next, alarm_step },
    { watchdog_next, watchdog_step }, { host_sensor_next, host_sensor_step },
    { host_i2c_next, host_i2c_step }, { host_uart_next, host_uart_step },
    { NULL, host_drdy_serve },
};

void hal_host_begin(const hal_host_config_t *config, const stream_t *stream, bool loop)
{
    host_clock_begin(config, parts, sizeof parts / sizeof parts[0]);
    cpu_hz = (uint32_t)HAL_HOST_HZ;
    *hal_host_faults() = (hal_host_faults_t){ .next_status = -1 };
    host_eeprom_power_on();
    host_sensor_begin(stream, loop);
    host_i2c_power_on();
    hal_host_reset_mcu(HAL_RESET_POWER_ON);
}

void hal_host_reset_mcu(uint8_t cause)
{
    host_clock_reset();
    host_drdy_reset();
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
    led_is_output = false;
    strap_pulled_up = false;
    host_i2c_begin();
    host_uart_begin();
}

void hal_host_set_cpu_hz(uint32_t hz)
{
    cpu_hz = hz;
}

uint32_t hal_host_cpu_hz(void)
{
    return cpu_hz;
}

uint64_t hal_host_watchdog_bite(void)
{
    return bitten_at;
}

bool hal_host_led(void)
{
    return led && led_is_output;
}

/* Of all interrupts only INT1's can come while main runs: in what hal_host_config_t makes happen. */
hal_irq_state_t hal_irq_save(void)
{
    return host_drdy_block(true);
}

void hal_irq_restore(hal_irq_state_t state)
{
    (void)host_drdy_block(state != 0);
}

void hal_irq_enable(void) {}

void hal_time_init(void)
{
    tick_at = hal_host_now() + (uint64_t)HAL_TICK_US * HOST_CYCLES_PER_US;
}

void hal_wake_at(uint32_t t_us)
{
    uint32_t ahead_us = (t_us - hal_time_us()) % ALARM_RANGE_US;
    uint64_t begun_at = hal_host_now() - hal_host_now() % HOST_CYCLES_PER_US; /* start of the current microsecond */
    alarm_at = begun_at + (uint64_t)(ahead_us == 0 ? ALARM_RANGE_US : ahead_us) * HOST_CYCLES_PER_US;
    if ((hal_time_us() - t_us) % ALARM_RANGE_US < HAL_WAKE_LATE_US) {
        hal_wake();
    }
}

void hal_watchdog_start(void)
{
    hal_watchdog_feed();
}

void hal_watchdog_feed(void)
{
    watchdog_at = hal_host_now() + (uint64_t)HAL_WATCHDOG_MS * 1000u * HOST_CYCLES_PER_US;
}

void hal_watchdog_note(uint8_t new_note)
{
    note = new_note;
}

hal_reset_t hal_reset_cause(void)
{
    return (hal_reset_t)reset_cause;
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

void hal_strap_init(void)
{
    strap_pulled_up = true;
}

/* Without its pull-up the pin floats, and may read low without a wire. */
bool hal_strap_low(void)
{
    return !strap_pulled_up || hal_host_faults()->strap_low;
}

void hal_led_init(void)
{
    led_is_output = true;
}

void hal_led_set(bool on)
{
    led = on;
}
