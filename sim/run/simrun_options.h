/* The command line. */
#ifndef SIMRUN_OPTIONS_H
#define SIMRUN_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "simrun_faults.h"
#include "simrun_machine.h"
#include "simrun_mcu.h"
#include "simrun_sensor.h"
#include "simrun_uart.h"

typedef struct {
    mcu_options_t mcu;
    machine_options_t machine;
    sensor_options_t sensor;
    uart_options_t uart;
    faults_options_t faults;
    const char *frames, *altered, *eeprom, *stats, *profile, *calls, *race, *vcd, *filter, *span; /* NULL: not given */
    bool pty, judge;
    double patience_s;
    unsigned expect_resets;
    uint32_t clock_start_us;
} options_t;

extern const char options_help[];

/* Prints the reason and exits with EXIT_INPUT (or EXIT_OK after --help). */
const options_t *options_parse(int argc, char **argv);

#endif
