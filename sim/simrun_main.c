/* simrun: see simrun.h for the parts, --help for the options. */
#include <stdlib.h>
#include <time.h>

#include "simrun.h"

static double seconds_between(const struct timespec *a, const struct timespec *b)
{
    return (double)(b->tv_sec - a->tv_sec) + 1e-9 * (double)(b->tv_nsec - a->tv_nsec);
}

int main(int argc, char **argv)
{
    options_parse(argc, argv);
    wires_start();
    machine_start();
    struct timespec began;
    struct timespec ended;
    clock_gettime(CLOCK_MONOTONIC, &began);
    const char *reason;
    exit_status_t status = machine_run(&reason);
    clock_gettime(CLOCK_MONOTONIC, &ended);
    stats_write(status);
    stats_profile_write();
    calls_write();
    stats_summary();
    sensor_print_mode(stderr);
    verdict_tell();
    faults_warn();
    race_finish();
    double seconds = seconds_between(&began, &ended);
    fprintf(stderr, "simrun: %.2f s of computing, %.0f times real time\n", seconds, machine_ms() / 1e3 / seconds);
    uart_finish();
    eeprom_finish();
    vcd_finish();
    span_finish();
    alter_finish();
    sensor_finish();
    if (status != EXIT_OK) {
        fprintf(stderr, "simrun: status %d: %s\n", (int)status, reason);
    }
    return (int)status;
}
