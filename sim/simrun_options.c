/* The command line. */
#include <getopt.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "simrun.h"

options_t options = { .seed = 1 };

#define PATIENCE_S 60.0

enum option_code {
    OPTION_FW = 256,
    OPTION_IN,
    OPTION_FRAMES,
    OPTION_OUT,
    OPTION_SERVED,
    OPTION_ALTERED,
    OPTION_EEPROM,
    OPTION_STATS,
    OPTION_PROFILE,
    OPTION_CALLS,
    OPTION_SPAN,
    OPTION_RACE,
    OPTION_VCD,
    OPTION_BOOTLOADER,
    OPTION_BLANK,
    OPTION_STRAP,
    OPTION_ALT_ADDRESS,
    OPTION_LOOP,
    OPTION_PTY,
    OPTION_PPM,
    OPTION_MAX_MS,
    OPTION_EXPECT_RESETS,
    OPTION_GDB,
    OPTION_SEED,
    OPTION_JUDGE,
    OPTION_CLOCK_START,
    OPTION_CMD,
    OPTION_FAULT,
    OPTION_SETTING,
    OPTION_FILTER,
    OPTION_PART,
    OPTION_SENSOR,
    OPTION_WIRES,
    OPTION_PATIENCE,
    OPTION_HELP
};

static const struct option known[] = { { "fw", required_argument, NULL, OPTION_FW },
                                       { "in", required_argument, NULL, OPTION_IN },
                                       { "frames", required_argument, NULL, OPTION_FRAMES },
                                       { "out", required_argument, NULL, OPTION_OUT },
                                       { "served", required_argument, NULL, OPTION_SERVED },
                                       { "altered", required_argument, NULL, OPTION_ALTERED },
                                       { "eeprom", required_argument, NULL, OPTION_EEPROM },
                                       { "stats", required_argument, NULL, OPTION_STATS },
                                       { "profile", required_argument, NULL, OPTION_PROFILE },
                                       { "calls", required_argument, NULL, OPTION_CALLS },
                                       { "span", required_argument, NULL, OPTION_SPAN },
                                       { "race", required_argument, NULL, OPTION_RACE },
                                       { "vcd", required_argument, NULL, OPTION_VCD },
                                       { "bootloader", required_argument, NULL, OPTION_BOOTLOADER },
                                       { "blank", no_argument, NULL, OPTION_BLANK },
                                       { "strap", no_argument, NULL, OPTION_STRAP },
                                       { "alt-address", no_argument, NULL, OPTION_ALT_ADDRESS },
                                       { "loop", no_argument, NULL, OPTION_LOOP },
                                       { "pty", no_argument, NULL, OPTION_PTY },
                                       { "ppm", required_argument, NULL, OPTION_PPM },
                                       { "max-ms", required_argument, NULL, OPTION_MAX_MS },
                                       { "patience", required_argument, NULL, OPTION_PATIENCE },
                                       { "expect-resets", required_argument, NULL, OPTION_EXPECT_RESETS },
                                       { "gdb", required_argument, NULL, OPTION_GDB },
                                       { "seed", required_argument, NULL, OPTION_SEED },
                                       { "judge", no_argument, NULL, OPTION_JUDGE },
                                       { "clock-start", required_argument, NULL, OPTION_CLOCK_START },
                                       { "cmd", required_argument, NULL, OPTION_CMD },
                                       { "fault", required_argument, NULL, OPTION_FAULT },
                                       { "rate", required_argument, NULL, OPTION_SETTING },
                                       { "baud", required_argument, NULL, OPTION_SETTING },
                                       { "every", required_argument, NULL, OPTION_SETTING },
                                       { "range", required_argument, NULL, OPTION_SETTING },
                                       { "filter", required_argument, NULL, OPTION_FILTER },
                                       { "sensor", required_argument, NULL, OPTION_SENSOR },
                                       { "wires", required_argument, NULL, OPTION_WIRES },
                                       { "part", required_argument, NULL, OPTION_PART },
                                       { "help", no_argument, NULL, OPTION_HELP },
                                       { NULL, 0, NULL, 0 } };

static void refuse(const char *format, ...) __attribute__((format(printf, 1, 2), noreturn));
static void refuse(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("simrun: ", stderr);
    vfprintf(stderr, format, arguments);
    fputs(" (simrun --help)\n", stderr);
    va_end(arguments);
    exit(EXIT_INPUT);
}

static double number(const char *name, const char *text, double low, double high)
{
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end != '\0' || !(value >= low && value <= high)) {
        refuse("--%s wants a number from %g to %g, not '%s'", name, low, high, text);
    }
    return value;
}

static void add_typed(double at_ms, const char *text, bool setting)
{
    if (options.typed_count == TYPED_MAX) {
        refuse("more than %d commands", TYPED_MAX);
    }
    options.typed[options.typed_count++] = (typed_line_t){ at_ms, text, setting };
}

/* "--rate 400" is the command "rate 400". */
static void add_setting(const char *name, const char *value)
{
    size_t length = strlen(name) + strlen(value) + 2;
    char *line = malloc(length);
    if (line == NULL) {
        refuse("out of memory");
    }
    snprintf(line, length, "%s %s", name, value);
    add_typed(0.0, line, true);
}

static void add_command(const char *argument)
{
    char *end;
    double at_ms = strtod(argument, &end);
    if (end == argument || *end != ':' || !(at_ms >= 0.0)) {
        refuse("--cmd wants MS:TEXT, not '%s'", argument);
    }
    add_typed(at_ms, end + 1, false);
}

/* If there is no such sensor, refuses with the list of names. */
static void set_sensor(const char *argument)
{
    char names[120] = "";
    options.variant = adxl345_variant_named(argument);
    for (size_t i = 0; options.variant == NULL && i < adxl345_variant_count; i++) {
        size_t length = strlen(names);
        snprintf(names + length, sizeof names - length, "%s%s", i == 0 ? "" : ", ", adxl345_variants[i].name);
    }
    if (options.variant == NULL) {
        refuse("--sensor '%s' is none of %s", argument, names);
    }
}

static void add_part(const char *argument)
{
    if (!part_take(argument, &options.part)) {
        refuse("--part wants gain=X,Y,Z (0.5 to 2), offset=X,Y,Z (-1000 to 1000) or selftest=X,Y,Z (-4096 to 4095), "
               "whole LSB, not '%s'",
               argument);
    }
}

static void set_wires(const char *argument)
{
    if (!wires_take(argument)) {
        refuse("--wires wants OHM,PF or OHM,PF,PF of SDA (100 to 100000 ohm, 0 to 10000 pF), not '%s'", argument);
    }
}

static void add_fault(const char *argument)
{
    if (options.fault_count == FAULTS_MAX) {
        refuse("more than %d faults", FAULTS_MAX);
    }
    options.faults[options.fault_count++] = argument;
}

/* Options that only store a name; false for all others. */
static bool take_file(int code, const char *argument)
{
    static const struct {
        int code;
        const char **target;
    } files[] = {
        { OPTION_FW, &options.fw },           { OPTION_IN, &options.in },
        { OPTION_OUT, &options.out },         { OPTION_SERVED, &options.served },
        { OPTION_EEPROM, &options.eeprom },   { OPTION_STATS, &options.stats },
        { OPTION_VCD, &options.vcd },         { OPTION_PROFILE, &options.profile },
        { OPTION_SPAN, &options.span },       { OPTION_BOOTLOADER, &options.bootloader },
        { OPTION_ALTERED, &options.altered }, { OPTION_FRAMES, &options.frames },
        { OPTION_CALLS, &options.calls },     { OPTION_RACE, &options.race },
    };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        if (files[i].code == code) {
            *files[i].target = argument;
            return true;
        }
    }
    return false;
}

static bool take_number(int code, const char *name, const char *argument)
{
    switch (code) {
    case OPTION_PPM:
        options.ppm = number(name, argument, -200000.0, 200000.0);
        return true;
    case OPTION_MAX_MS:
        options.max_ms = number(name, argument, 0.001, 1e9);
        return true;
    case OPTION_PATIENCE:
        options.patience_s = number(name, argument, 0.01, 1e6);
        return true;
    case OPTION_EXPECT_RESETS:
        options.expect_resets = (unsigned)number(name, argument, 0.0, 1e6);
        return true;
    case OPTION_GDB:
        options.gdb_port = (unsigned)number(name, argument, 1.0, 65535.0);
        return true;
    case OPTION_SEED:
        options.seed = (uint32_t)number(name, argument, 1.0, 4294967295.0);
        return true;
    case OPTION_CLOCK_START:
        options.clock_start_us = (uint32_t)number(name, argument, 0.0, 4294967295.0);
        return true;
    default:
        return false;
    }
}

/* Options without an argument; false for all others. */
static bool take_switch(int code)
{
    static const struct {
        int code;
        bool *option;
    } switches[] = { { OPTION_LOOP, &options.loop },
                     { OPTION_PTY, &options.pty },
                     { OPTION_BLANK, &options.blank },
                     { OPTION_STRAP, &options.strap },
                     { OPTION_ALT_ADDRESS, &options.alt_address },
                     { OPTION_JUDGE, &options.judge } };
    for (size_t i = 0; i < sizeof switches / sizeof switches[0]; i++) {
        if (switches[i].code == code) {
            *switches[i].option = true;
            return true;
        }
    }
    return false;
}

static void take(int code, const char *name, const char *argument)
{
    switch (code) {
    case OPTION_CMD:
        add_command(argument);
        break;
    case OPTION_FAULT:
        add_fault(argument);
        break;
    case OPTION_SENSOR:
        set_sensor(argument);
        break;
    case OPTION_WIRES:
        set_wires(argument);
        break;
    case OPTION_PART:
        add_part(argument);
        break;
    case OPTION_FILTER:
        options.filter = argument;
        add_setting(name, argument);
        break;
    case OPTION_SETTING:
        add_setting(name, argument);
        break;
    case OPTION_HELP:
        fputs(options_help, stdout);
        exit(EXIT_OK);
    default:
        if (!take_switch(code) && !take_file(code, argument) && !take_number(code, name, argument)) {
            exit(EXIT_INPUT); /* getopt has printed the reason */
        }
        break;
    }
}

/* Exactly one kind of input to the firmware, and the file for its output. */
static void check_files(void)
{
    if (options.fw == NULL || options.out == NULL || (options.in == NULL && options.frames == NULL)) {
        refuse("--fw, --in (or --frames) and --out are needed");
    }
    if (options.frames != NULL && (options.in != NULL || options.pty)) {
        refuse("--frames goes with neither --in nor --pty");
    }
}

/* Its waits are in simulated time, and the program at the other end would not know about them. */
static void check_race(void)
{
    if (options.race != NULL && (options.gdb_port != 0 || options.pty)) {
        refuse("--race goes with neither --gdb nor --pty");
    }
}

/* Conflicts between options. */
static void check_together(void)
{
    check_files();
    check_race();
    if (options.blank && options.bootloader == NULL) {
        refuse("--blank leaves nothing to run: give --bootloader");
    }
    if (options.patience_s > 0.0 && !options.pty) {
        refuse("--patience is for a terminal: give --pty");
    }
    if (options.loop && options.max_ms <= 0.0 && options.gdb_port == 0 && !options.pty) {
        refuse("--loop never ends: give --max-ms");
    }
}

void options_parse(int argc, char **argv)
{
    int index = 0;
    int code;
    options.variant = adxl345_itself;
    options.part = adxl345_part_typical;
    while ((code = getopt_long(argc, argv, "", known, &index)) != -1) {
        take(code, known[index].name, optarg);
    }
    if (optind < argc) {
        refuse("'%s' is no option", argv[optind]);
    }
    check_together();
    part_complete(options.variant, &options.part);
    options.patience_s = options.patience_s > 0.0 ? options.patience_s : PATIENCE_S;
}
