#include "simrun_faults_parse.h"

#include <stdlib.h>
#include <string.h>

#include "simrun_mcu.h"
#include "simrun_output.h"
#include "simrun_symbols.h"

enum { POWER_OFF_MS = 5 };
#define LAST_MS 1e9 /* the limit of --max-ms */

const kind_properties_t fault_kinds[KIND_COUNT] = {
    [KIND_UNPLUG] = { .name = "unplug", .lasts = true, .detectable = true },
    [KIND_PLUG] = { .name = "plug", .detectable = true },
    [KIND_POWER] = { .name = "power", .lasts = true, .detectable = true },
    [KIND_SDA] = { .name = "sda", .lasts = true, .detectable = true },
    [KIND_SCL] = { .name = "scl", .lasts = true, .detectable = true },
    [KIND_HANG] = { "hang", false, true, true, false, 1, 5, 16 },
    [KIND_ARB] = { .name = "arb", .on_bus = true, .detectable = true },
    [KIND_BUSERR] = { .name = "buserr", .on_bus = true, .detectable = true },
    [KIND_NACK] = { .name = "nack", .on_bus = true, .detectable = true },
    [KIND_NACKDATA] = { .name = "nackdata", .on_bus = true, .detectable = true },
    [KIND_DEVID] = { "devid", true, false, true, false, 0, 0, 255 },
    [KIND_NOINT] = { .name = "noint", .lasts = true, .detectable = true },
    [KIND_INTHIGH] = { .name = "inthigh", .lasts = true, .detectable = true },
    [KIND_RESET] = { .name = "reset", .on_bus = true, .detectable = true },
    [KIND_MCUPOWER] = { "mcupower", false, true, true, false, EEPROM_LEFT_FF, EEPROM_LEFT_RANDOM, EEPROM_LEFT_RANDOM,
                        .left = true },
    [KIND_BROWNOUT] = { .name = "brownout", .on_bus = true, .detectable = true },
    [KIND_TORN] = { .name = "torn", .on_bus = true, .detectable = true },
    [KIND_STARVE] = { .name = "starve", .lasts = true, .detectable = true },
    [KIND_OVERRUN] = { "overrun", true, false, true, false, 1, 1, 1000 },
    [KIND_POKE] = { .name = "poke", .detectable = true },
    [KIND_FLIP] = { "flip", false, true, false, false, 1, 1, 8 },
    [KIND_NOISE] = { "noise", false, false, false, false, 1, 20, 4096 },
    [KIND_DOUBLE] = { "double", false, false, false, true, 0, 2, 2 },
    [KIND_FROZEN] = { .name = "frozen", .lasts = true, .detectable = true },
    [KIND_STORM] = { "storm", true, false, true, false, 1, 1000, 500000 },
    [KIND_ODR] = { "odr", true, false, true, false, -200000, 50000, 200000 },
    [KIND_RXFLOOD] = { .name = "rxflood", .lasts = true, .detectable = true },
    [KIND_MIXED] = { .name = "mixed", .on_bus = true },
    [KIND_GLITCH] = { "glitch", false, false, true, false, 1, 64, 64 },
    [KIND_CLIP] = { "clip", true, false, true, true, 0, 2, 2 },
    [KIND_TXSTALL] = { .name = "txstall", .lasts = true, .detectable = true },
    [KIND_RXSPOIL] = { "rxspoil", false, false, true, false, 0, 0, 1 },
};

static void refuse(const char *text, const char *reason) __attribute__((noreturn));
static void refuse(const char *text, const char *reason)
{
    output_refuse("--fault %s: %s (simrun --help)", text, reason);
}

/* The text up to the next ':' or the end, cut off; NULL if there is none. */
static char *next_part(char **rest)
{
    char *part = *rest;
    if (part == NULL) {
        return NULL;
    }
    char *colon = strchr(part, ':');
    *rest = colon == NULL ? NULL : colon + 1;
    if (colon != NULL) {
        *colon = '\0';
    }
    return part;
}

static double number(const fault_t *fault, const char *text, char **end)
{
    double value = strtod(text, end);
    if (*end == text || !(value >= 0.0 && value <= 4294967295.0)) {
        refuse(fault->text, "a number is missing or out of range");
    }
    return value;
}

/* A whole number that begins at text and ends with the character `stop`; *rest points after it. */
static uint32_t whole(const fault_t *fault, const char *text, char stop, char **rest)
{
    unsigned long value = strtoul(text, rest, 0);
    if (*rest == text || **rest != stop || value > UINT32_MAX) {
        refuse(fault->text, "a whole number is missing or malformed");
    }
    *rest += stop != '\0';
    return (uint32_t)value;
}

/* The same for values counted from 1. */
static uint32_t ordinal(const fault_t *fault, const char *text, char stop, char **rest)
{
    uint32_t value = whole(fault, text, stop, rest);
    if (value == 0) {
        refuse(fault->text, "transfers, bytes, visits and writes are counted from 1");
    }
    return value;
}

static void parse_symbol(fault_t *fault, char *text)
{
    char *hash = strchr(text, '#');
    fault->visits_left = 1;
    if (hash != NULL) {
        *hash = '\0';
        char *end;
        fault->visits_left = ordinal(fault, hash + 1, '\0', &end);
    }
    if (*text == '\0' || !symbols_find(text, &fault->pc)) {
        refuse(fault->text, "no such function in the firmware");
    }
}

/* The number of a write, optionally with .before or .after. */
static void parse_write(fault_t *fault, char *text)
{
    char *end;
    char *dot = strchr(text, '.');
    if (dot == NULL) {
        fault->eeprom_write = ordinal(fault, text, '\0', &end);
        return;
    }
    fault->eeprom_write = ordinal(fault, text, '.', &end);
    if (strcmp(dot, ".before") != 0 && strcmp(dot, ".after") != 0) {
        refuse(fault->text, "eeprom: wants N, N.before or N.after");
    }
    fault->eeprom_moment = strcmp(dot, ".before") == 0 ? EEPROM_BEFORE : EEPROM_AFTER;
}

/* What follows xfer:, pc:, eeprom: or p: */
static void parse_occasion(fault_t *fault, char *text)
{
    char *end = text;
    switch (fault->when) {
    case WHEN_BYTE:
        fault->transfer = ordinal(fault, text, '.', &end);
        fault->byte = ordinal(fault, end, '\0', &end);
        break;
    case WHEN_PC:
        parse_symbol(fault, text);
        break;
    case WHEN_EEPROM:
        parse_write(fault, text);
        break;
    default: {
        double chance = number(fault, text, &end);
        if (chance > 1.0 || *end != '\0') {
            refuse(fault->text, "p: wants a chance from 0 to 1");
        }
        fault->chance = (uint32_t)(chance * 4294967295.0);
        break;
    }
    }
}

static void parse_when(fault_t *fault, char **rest)
{
    static const char *const names[] = {
        [WHEN_BYTE] = "xfer", [WHEN_PC] = "pc", [WHEN_EEPROM] = "eeprom", [WHEN_SAMPLE] = "p"
    };
    char *part = next_part(rest);
    fault->when = WHEN_MS;
    for (when_t w = WHEN_BYTE; w <= WHEN_SAMPLE; w++) {
        fault->when = strcmp(part, names[w]) == 0 ? w : fault->when;
    }
    if (fault->when != WHEN_MS) {
        part = next_part(rest);
        if (part == NULL) {
            refuse(fault->text, "WHEN is not complete");
        }
        parse_occasion(fault, part);
        return;
    }
    char *end = NULL;
    double at_ms = strtod(part, &end);
    if (end == part || strcmp(end, "ms") != 0) {
        refuse(fault->text, "WHEN is 12.3ms, xfer:N.K, pc:SYMBOL#N, eeprom:N or p:CHANCE");
    }
    if (!(at_ms >= 0.0 && at_ms <= LAST_MS)) {
        refuse(fault->text, "WHEN is before the beginning or too late");
    }
    fault->at = (uint64_t)(at_ms * CYCLES_PER_MS);
}

static void parse_kind(fault_t *fault, const char *name)
{
    for (kind_t k = 0; name != NULL && k < KIND_COUNT; k++) {
        if (strcmp(name, fault_kinds[k].name) == 0) {
            fault->kind = k;
            fault->parameter = fault_kinds[k].usual;
            fault->lasts = k == KIND_POWER ? (uint64_t)POWER_OFF_MS * CYCLES_PER_MS : NEVER;
            return;
        }
    }
    refuse(fault->text, "no such KIND");
}

/* SYMBOL=VALUE: a byte of the firmware's RAM. */
static void parse_poke(fault_t *fault, char *text)
{
    char *equals = text == NULL ? NULL : strchr(text, '=');
    if (equals == NULL) {
        refuse(fault->text, "poke wants SYMBOL=VALUE");
    }
    *equals = '\0';
    char *end;
    uint32_t value = whole(fault, equals + 1, '\0', &end);
    fault->parameter = (int32_t)(uint8_t)value;
    if (value > UINT8_MAX || !symbols_find_variable(text, &fault->address)) {
        refuse(fault->text, "no such variable in the firmware, or a value above 255");
    }
}

static int32_t parse_axis(const fault_t *fault, const char *text)
{
    if (strlen(text) != 1 || *text < 'x' || *text > 'z') {
        static char reason[40];
        snprintf(reason, sizeof reason, "%s wants an axis: x, y or z", fault_kinds[fault->kind].name);
        refuse(fault->text, reason);
    }
    return *text - 'x';
}

static int32_t parse_left(const fault_t *fault, const char *text)
{
    static const char *const names[] = {
        [EEPROM_LEFT_FF] = "ff", [EEPROM_LEFT_OLD] = "old", [EEPROM_LEFT_NEW] = "new", [EEPROM_LEFT_RANDOM] = "random"
    };
    for (eeprom_left_t left = EEPROM_LEFT_FF; left <= EEPROM_LEFT_RANDOM; left++) {
        if (strcmp(text, names[left]) == 0) {
            return (int32_t)left;
        }
    }
    refuse(fault->text, "mcupower wants what it leaves of a byte of EEPROM: ff, old, new or random");
}

/* A whole number that may be negative. */
static int32_t parse_number(const fault_t *fault, const char *text)
{
    const kind_properties_t *kind = &fault_kinds[fault->kind];
    char *end = NULL;
    long value = strtol(text, &end, 0);
    if (end == text || *end != '\0' || value < kind->lowest || value > kind->highest) {
        char reason[80];
        snprintf(reason, sizeof reason, "%s wants a whole number from %ld to %ld", kind->name, (long)kind->lowest,
                 (long)kind->highest);
        refuse(fault->text, reason);
    }
    return (int32_t)value;
}

static int32_t parse_parameter(const fault_t *fault, const char *text)
{
    const kind_properties_t *kind = &fault_kinds[fault->kind];
    return kind->axis ? parse_axis(fault, text) : kind->left ? parse_left(fault, text) : parse_number(fault, text);
}

static void parse_what(fault_t *fault, char **rest)
{
    parse_kind(fault, next_part(rest));
    char *end = NULL;
    char *part = next_part(rest);
    if (fault->kind == KIND_POKE) {
        parse_poke(fault, part);
        part = next_part(rest);
    } else if (part != NULL && fault_kinds[fault->kind].highest != 0) {
        fault->parameter = parse_parameter(fault, part);
        part = next_part(rest);
    }
    if (part != NULL && fault_kinds[fault->kind].lasts) {
        fault->lasts = (uint64_t)(number(fault, part, &end) * CYCLES_PER_MS);
        if (*end != '\0') {
            refuse(fault->text, "MS is not a number");
        }
        part = next_part(rest);
    }
    if (part != NULL) {
        refuse(fault->text, "too many parts for this KIND");
    }
}

void fault_parse(fault_t *fault, const char *text)
{
    *fault = (fault_t){ .text = text, .armed = true, .ends = NEVER };
    char *copy = strdup(text);
    if (copy == NULL) {
        refuse(text, "out of memory");
    }
    char *rest = copy;
    parse_when(fault, &rest);
    parse_what(fault, &rest);
    free(copy);
}
