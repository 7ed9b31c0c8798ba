#include "simrun_options.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "simrun_output.h"
#include "simrun_wires.h"

static options_t options = { .mcu = { .seed = 1 } };
static bool self_test_named;

#define PATIENCE_S 60.0
#define SEE_HELP " (simrun --help)"

enum { AXES = 3 };

static double number(const char *name, const char *text, double low, double high)
{
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end != '\0' || !(value >= low && value <= high)) {
        output_refuse("--%s wants a number from %g to %g, not '%s'" SEE_HELP, name, low, high, text);
    }
    return value;
}

static void add_typed(double at_ms, const char *text, bool setting)
{
    if (options.uart.typed_count == TYPED_MAX) {
        output_refuse("more than %d commands" SEE_HELP, TYPED_MAX);
    }
    options.uart.typed[options.uart.typed_count++] = (typed_line_t){ at_ms, text, setting };
}

/* "--rate 400" is the command "rate 400". */
static void add_setting(const char *name, const char *value)
{
    size_t length = strlen(name) + strlen(value) + 2;
    char *line = malloc(length);
    if (line == NULL) {
        output_refuse("out of memory" SEE_HELP);
    }
    snprintf(line, length, "%s %s", name, value);
    add_typed(0.0, line, true);
}

static void add_command(const char *argument)
{
    char *end;
    double at_ms = strtod(argument, &end);
    if (end == argument || *end != ':' || !(at_ms >= 0.0)) {
        output_refuse("--cmd wants MS:TEXT, not '%s'" SEE_HELP, argument);
    }
    add_typed(at_ms, end + 1, false);
}

/* If there is no such sensor, refuses with the list of names. */
static void set_sensor(const char *argument)
{
    char names[120] = "";
    options.sensor.variant = adxl345_variant_named(argument);
    for (size_t i = 0; options.sensor.variant == NULL && i < adxl345_variant_count; i++) {
        size_t length = strlen(names);
        snprintf(names + length, sizeof names - length, "%s%s", i == 0 ? "" : ", ", adxl345_variants[i].name);
    }
    if (options.sensor.variant == NULL) {
        output_refuse("--sensor '%s' is none of %s" SEE_HELP, argument, names);
    }
}

/* Three numbers from low to high separated by commas, and nothing after them. */
static bool three(const char *text, double low, double high, double value[AXES])
{
    for (size_t axis = 0; axis < AXES; axis++) {
        char *end;
        value[axis] = strtod(text, &end);
        bool ended = *end == (axis + 1 < AXES ? ',' : '\0');
        if (end == text || !ended || !(value[axis] >= low && value[axis] <= high)) {
            return false;
        }
        text = end + 1;
    }
    return true;
}

static bool whole(const char *text, double low, double high, int16_t lsb[AXES])
{
    double value[AXES];
    if (!three(text, low, high, value)) {
        return false;
    }
    for (size_t axis = 0; axis < AXES; axis++) {
        lsb[axis] = (int16_t)value[axis];
        if (lsb[axis] < value[axis] || lsb[axis] > value[axis]) {
            return false;
        }
    }
    return true;
}

static bool take_one(const char *text, adxl345_part_t *part)
{
    if (strncmp(text, "gain=", 5) == 0) {
        return three(text + 5, 0.5, 2.0, part->gain);
    }
    if (strncmp(text, "offset=", 7) == 0) {
        return whole(text + 7, -1000.0, 1000.0, part->offset_lsb);
    }
    if (strncmp(text, "selftest=", 9) == 0) {
        self_test_named = true;
        return whole(text + 9, -4096.0, 4095.0, part->self_test_lsb);
    }
    return false;
}

/* --part: what differs from one sensor of a kind to the next. */
static bool take_part(const char *argument, adxl345_part_t *part)
{
    char copy[200];
    char *rest = NULL;
    if (strlen(argument) >= sizeof copy) {
        return false;
    }
    strcpy(copy, argument);
    char *one = strtok_r(copy, " ", &rest);
    bool good = one != NULL;
    for (; one != NULL && good; one = strtok_r(NULL, " ", &rest)) {
        good = take_one(one, part);
    }
    return good;
}

static void add_part(const char *argument)
{
    if (!take_part(argument, &options.sensor.part)) {
        output_refuse(
            "--part wants gain=X,Y,Z (0.5 to 2), offset=X,Y,Z (-1000 to 1000) or selftest=X,Y,Z (-4096 to 4095), "
            "whole LSB, not '%s'" SEE_HELP,
            argument);
    }
}

static void set_wires(const char *argument)
{
    if (!wires_take(argument)) {
        output_refuse("--wires wants OHM,PF or OHM,PF,PF of SDA (100 to 100000 ohm, 0 to 10000 pF), not '%s'" SEE_HELP,
                      argument);
    }
}

static void add_fault(const char *argument)
{
    if (options.faults.count == FAULTS_MAX) {
        output_refuse("more than %d faults" SEE_HELP, FAULTS_MAX);
    }
    options.faults.texts[options.faults.count++] = argument;
}

static bool help_wanted;

/* What each does with its argument. */
typedef struct {
    const char *name;
    const char **text;                  /* stores it, */
    bool *flag;                         /* has none, */
    void (*take)(const char *argument); /* parses it, */
    double *number;                     /* takes it for a number, */
    unsigned *whole;
    double low, high; /* of the number */
    bool setting;     /* and types it as a command */
} known_t;

static const known_t known[] = {
    { "fw", .text = &options.mcu.fw },
    { "in", .text = &options.sensor.in },
    { "frames", .text = &options.frames },
    { "out", .text = &options.uart.out },
    { "served", .text = &options.sensor.served },
    { "altered", .text = &options.altered },
    { "eeprom", .text = &options.eeprom },
    { "stats", .text = &options.stats },
    { "profile", .text = &options.profile },
    { "calls", .text = &options.calls },
    { "span", .text = &options.span },
    { "race", .text = &options.race },
    { "vcd", .text = &options.vcd },
    { "bootloader", .text = &options.mcu.bootloader },
    { "blank", .flag = &options.mcu.blank },
    { "strap", .flag = &options.mcu.strap },
    { "alt-address", .flag = &options.sensor.alt_address },
    { "loop", .flag = &options.sensor.loop },
    { "pty", .flag = &options.pty },
    { "ppm", .number = &options.sensor.ppm, .low = -200000.0, .high = 200000.0 },
    { "max-ms", .number = &options.machine.max_ms, .low = 0.001, .high = 1e9 },
    { "patience", .number = &options.patience_s, .low = 0.01, .high = 1e6 },
    { "expect-resets", .whole = &options.expect_resets, .low = 0.0, .high = 1e6 },
    { "gdb", .whole = &options.machine.gdb_port, .low = 1.0, .high = 65535.0 },
    { "seed", .whole = &options.mcu.seed, .low = 1.0, .high = 4294967295.0 },
    { "judge", .flag = &options.judge },
    { "clock-start", .whole = &options.clock_start_us, .low = 0.0, .high = 4294967295.0 },
    { "cmd", .take = add_command },
    { "fault", .take = add_fault },
    { "rate", .setting = true },
    { "baud", .setting = true },
    { "every", .setting = true },
    { "range", .setting = true },
    { "filter", .text = &options.filter, .setting = true },
    { "sensor", .take = set_sensor },
    { "wires", .take = set_wires },
    { "part", .take = add_part },
    { "help", .flag = &help_wanted },
};

enum { KNOWN = sizeof known / sizeof known[0], FIRST_CODE = 256 };

static void take(const known_t *option, const char *argument)
{
    if (option->text != NULL) {
        *option->text = argument;
    }
    if (option->setting) {
        add_setting(option->name, argument);
    }
    if (option->flag != NULL) {
        *option->flag = true;
    }
    if (option->take != NULL) {
        option->take(argument);
    }
    if (option->number != NULL) {
        *option->number = number(option->name, argument, option->low, option->high);
    }
    if (option->whole != NULL) {
        *option->whole = (unsigned)number(option->name, argument, option->low, option->high);
    }
    if (help_wanted) {
        fputs(options_help, stdout);
        exit(EXIT_OK);
    }
}

/* Exactly one kind of input to the firmware, and the file for its output. */
static void check_files(void)
{
    if (options.mcu.fw == NULL || options.uart.out == NULL || (options.sensor.in == NULL && options.frames == NULL)) {
        output_refuse("--fw, --in (or --frames) and --out are needed" SEE_HELP);
    }
    if (options.frames != NULL && (options.sensor.in != NULL || options.pty)) {
        output_refuse("--frames goes with neither --in nor --pty" SEE_HELP);
    }
}

/* Its waits are in simulated time, and the program at the other end would not know about them. */
static void check_race(void)
{
    if (options.race != NULL && (options.machine.gdb_port != 0 || options.pty)) {
        output_refuse("--race goes with neither --gdb nor --pty" SEE_HELP);
    }
}

/* Conflicts between options. */
static void check_together(void)
{
    check_files();
    check_race();
    if (options.mcu.blank && options.mcu.bootloader == NULL) {
        output_refuse("--blank leaves nothing to run: give --bootloader" SEE_HELP);
    }
    if (options.patience_s > 0.0 && !options.pty) {
        output_refuse("--patience is for a terminal: give --pty" SEE_HELP);
    }
    if (options.sensor.loop && options.machine.max_ms <= 0.0 && options.machine.gdb_port == 0 && !options.pty) {
        output_refuse("--loop never ends: give --max-ms" SEE_HELP);
    }
}

const options_t *options_parse(int argc, char **argv)
{
    struct option list[KNOWN + 1] = { 0 };
    int code;
    for (size_t i = 0; i < KNOWN; i++) {
        list[i] = (struct option){ known[i].name, known[i].flag == NULL ? required_argument : no_argument, NULL,
                                   FIRST_CODE + (int)i };
    }
    options.sensor.variant = adxl345_itself;
    options.sensor.part = adxl345_part_typical;
    while ((code = getopt_long(argc, argv, "", list, NULL)) >= FIRST_CODE) {
        take(&known[code - FIRST_CODE], optarg);
    }
    if (code != -1) {
        exit(EXIT_INPUT); /* getopt has printed the reason */
    }
    if (optind < argc) {
        output_refuse("'%s' is no option" SEE_HELP, argv[optind]);
    }
    check_together();
    if (!self_test_named) {
        memcpy(options.sensor.part.self_test_lsb, options.sensor.variant->self_test_lsb,
               sizeof options.sensor.part.self_test_lsb);
    }
    options.patience_s = options.patience_s > 0.0 ? options.patience_s : PATIENCE_S;
    options.machine.interactive = options.pty || options.machine.gdb_port != 0;
    return &options;
}
