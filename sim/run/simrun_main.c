/*
 * simrun: the unmodified UNO firmware in libsimavr, with the virtual ADXL345 on its bus and a recorded stream in the
 * sensor. Each part is one `simrun_<part>.c` with its own state; this one starts them, ties them together where
 * something below acts on something above, and ends them.
 */
#include <stdbool.h>
#include <stdio.h>
#include <time.h>

#include "simrun_alter.h"
#include "simrun_eeprom.h"
#include "simrun_events.h"
#include "simrun_failure.h"
#include "simrun_faults.h"
#include "simrun_frames.h"
#include "simrun_machine.h"
#include "simrun_mcu.h"
#include "simrun_options.h"
#include "simrun_output.h"
#include "simrun_profile.h"
#include "simrun_pty.h"
#include "simrun_race.h"
#include "simrun_resets.h"
#include "simrun_rows.h"
#include "simrun_rules.h"
#include "simrun_sensor.h"
#include "simrun_span.h"
#include "simrun_stack.h"
#include "simrun_times.h"
#include "simrun_uart.h"
#include "simrun_vcd.h"
#include "simrun_wires.h"
#include "twi_peripheral.h"

static twi_peripheral_t twi;

static void on_row(const row_t *row)
{
    rows_take(row, faults_over());
    faults_on_row(row);
}

static void on_bus_byte(void *owner, uint32_t transfer, uint32_t byte)
{
    (void)owner;
    faults_on_byte(transfer, byte);
}

static void after_bus_byte(void *owner)
{
    (void)owner;
    sensor_check_rate();
    faults_after_byte();
}

static void on_reset(bool power_lost)
{
    twi_reset(&twi);
    uart_reset();
    times_reset();
    profile_reset();
    span_reset();
    faults_on_reset();
    rules_on_reset();
    eeprom_reset(power_lost);
    sensor_show_pin();
    events_reschedule();
}

static void start_bus(void)
{
    twi.sensor = &sensor;
    twi.before_byte = on_bus_byte;
    twi.after_byte = after_bus_byte;
    if (!twi_attach(&twi, mcu)) {
        output_refuse("libsimavr: no two-wire interface in it");
    }
}

static void start_line(const options_t *options)
{
    uart_start(&options->uart, on_row);
    if (options->pty) {
        pty_open(options->mcu.blank, options->patience_s);
        uart_type_at_once();
    }
    frames_start(options->frames);
}

/* What looks on; true: at each instruction. */
static bool start_watchers(const options_t *options)
{
    rows_start(options->clock_start_us);
    times_start();
    profile_start(options->profile, options->calls);
    alter_start(options->altered, &twi);
    bool each = faults_start(&options->faults, &twi);
    each |= span_start(options->span);
    each |= race_start(options->race);
    rules_start();
    return each;
}

/* True: each instruction is looked at. */
static bool start(const options_t *options)
{
    events_add(sensor_next, sensor_step);
    events_add(uart_next, uart_step);
    events_add(faults_next, faults_step);
    events_add(eeprom_next, eeprom_step);
    wires_start(&twi);
    machine_prepare(&options->machine);
    mcu_start(&options->mcu);
    stack_paint();
    machine_start();
    vcd_start(options->vcd);
    sensor_start(&options->sensor);
    start_bus();
    start_line(options);
    eeprom_start(options->eeprom);
    bool each = start_watchers(options);
    resets_start(options->mcu.bootloader != NULL, on_reset);
    return each;
}

/* The status and, if it is not EXIT_OK, the reason; static text. */
static exit_status_t conclude(const options_t *options, const char **reason)
{
    static char text[80];
    if (failure_asked_to_end() && !options->machine.interactive) {
        failure_set(EXIT_INTERNAL, "ended by a signal");
    }
    exit_status_t status = failure_end(reason);
    if (status == EXIT_OK && resets_count() != options->expect_resets) {
        status = EXIT_RESETS;
        snprintf(text, sizeof text, "%u resets of the MCU, %u expected (--expect-resets)", (unsigned)resets_count(),
                 options->expect_resets);
        *reason = text;
    } else if (status == EXIT_OK && options->judge && rows_fault() != NULL) {
        status = EXIT_WRONG;
        *reason = rows_fault();
    }
    return status;
}

static void write_bus(FILE *file)
{
    fprintf(file, "  \"i2c_transfers\": %u,\n  \"i2c_bytes\": %llu,\n", (unsigned)twi.transfer,
            (unsigned long long)twi.bytes);
    fprintf(file, "  \"i2c_hand_clocks_max\": %u,\n  \"i2c_hand_stops\": %u,\n  \"i2c_driven_high\": %s,\n",
            (unsigned)twi.hand_clocks_max, (unsigned)twi.hand_stops, twi.driven_high ? "true" : "false");
    fprintf(file, "  \"i2c_load\": %.5f,\n", mcu->cycle == 0 ? 0.0 : (double)twi.busy_cycles / (double)mcu->cycle);
}

static void write_samples(FILE *file)
{
    sensor_print(file);
    fprintf(file, "  \"samples_altered\": %u,\n", (unsigned)alter_count());
    frames_print(file);
    rows_print(file);
    eeprom_print(file);
    rules_print(file);
    uart_print(file);
}

static void write_stats(const options_t *options, exit_status_t status)
{
    FILE *file = output_open(options->stats);
    fprintf(file, "{\n  \"exit_status\": %d,\n  \"sim_ms\": %.3f,\n", (int)status, mcu_ms());
    if (options->filter != NULL) {
        fprintf(file, "  \"filter\": \"%s\",\n", options->filter);
    }
    write_samples(file);
    write_bus(file);
    fprintf(file, "  \"cpu_load\": %.5f,\n", times_load());
    times_print(file);
    fprintf(file, "  \"simulator_steps\": %llu,\n", (unsigned long long)machine_steps());
    unsigned ram = mcu_program.end_of_ram - RAM_START;
    fprintf(file, "  \"flash_bytes\": %u,\n  \"ram_static_bytes\": %u,\n", (unsigned)mcu_program.flash_bytes, ram);
    fprintf(file, "  \"stack_high_water_bytes\": %u,\n  \"ram_used_bytes\": %u,\n", (unsigned)stack_high_water(),
            ram + (unsigned)stack_high_water());
    faults_print(file);
    rows_print_verdict(file);
    fprintf(file, "  \"boot_resets\": %u,\n  \"resets\": %u\n}\n", (unsigned)resets_boot_count(),
            (unsigned)resets_count());
    output_close(file, options->stats);
}

static void print_summary(void)
{
    fprintf(stderr, "simrun: %.1f ms, %zu samples served, %zu rows, load %.2f %%, stack %u of %u bytes, %u resets\n",
            mcu_ms(), sensor_served_count(), rows_count(), 100.0 * times_load(), (unsigned)stack_high_water(),
            (unsigned)(RAM_END + 1 - mcu_program.end_of_ram), (unsigned)resets_count());
}

static void report(const options_t *options, exit_status_t status, double seconds)
{
    if (options->stats != NULL) {
        write_stats(options, status);
    }
    profile_finish();
    print_summary();
    sensor_print_mode(stderr);
    rows_tell();
    faults_warn();
    race_finish();
    fprintf(stderr, "simrun: %.2f s of computing, %.0f times real time\n", seconds, mcu_ms() / 1e3 / seconds);
}

static void finish(void)
{
    uart_finish();
    eeprom_finish();
    vcd_finish();
    span_finish();
    alter_finish();
    sensor_finish();
}

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int main(int argc, char **argv)
{
    const options_t *options = options_parse(argc, argv);
    bool each = start(options);
    double began = now_s();
    machine_run(each);
    double seconds = now_s() - began;
    const char *reason;
    exit_status_t status = conclude(options, &reason);
    report(options, status, seconds);
    finish();
    if (status != EXIT_OK) {
        fprintf(stderr, "simrun: status %d: %s\n", (int)status, reason);
    }
    return (int)status;
}
