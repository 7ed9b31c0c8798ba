/* A fault of the command line: WHEN:KIND[:PARAM][:MS]. */
#ifndef SIMRUN_FAULTS_PARSE_H
#define SIMRUN_FAULTS_PARSE_H

#include <stdbool.h>
#include <stdint.h>

#include "simrun_eeprom.h"

typedef enum { WHEN_MS, WHEN_BYTE, WHEN_PC, WHEN_EEPROM, WHEN_SAMPLE } when_t;

typedef enum {
    KIND_UNPLUG,
    KIND_PLUG,
    KIND_POWER,
    KIND_SDA,
    KIND_SCL,
    KIND_HANG,
    KIND_ARB,
    KIND_BUSERR,
    KIND_NACK,
    KIND_NACKDATA,
    KIND_DEVID,
    KIND_NOINT,
    KIND_INTHIGH,
    KIND_RESET,
    KIND_MCUPOWER,
    KIND_BROWNOUT,
    KIND_POKE,
    KIND_TORN,
    KIND_STARVE,
    KIND_OVERRUN,
    KIND_FLIP, /* from here on: simrun_alter.c */
    KIND_NOISE,
    KIND_DOUBLE,
    KIND_FROZEN,
    KIND_STORM,
    KIND_ODR,
    KIND_RXFLOOD,
    KIND_MIXED,
    KIND_GLITCH,
    KIND_CLIP,
    KIND_TXSTALL,
    KIND_RXSPOIL,
    KIND_COUNT
} kind_t;

typedef struct {
    const char *text;
    when_t when;
    kind_t kind;
    uint64_t at; /* WHEN_MS: cycle */
    uint32_t transfer, byte;
    uint32_t bytes_left; /* WHEN_SAMPLE on the bus: bytes until it begins, 0: not in progress */
    uint32_t pc, visits_left;
    uint32_t eeprom_write;
    eeprom_moment_t eeprom_moment;
    uint32_t chance; /* WHEN_SAMPLE: of 2^32 */
    int32_t parameter;
    uint32_t address; /* KIND_POKE: of the variable */
    uint32_t overruns_before;
    uint64_t lasts; /* cycles, NEVER: to the end of the run */
    bool armed;     /* still to come (WHEN_SAMPLE: always) */
    bool active;
    uint64_t ends;    /* cycle, while active */
    bool awaits_byte; /* has begun, but no byte has been affected yet: it ends once one has */
    bool awaits_row;
    uint64_t ended_at;
    uint32_t injected, recovered;
    double worst_ms, first_ms;
} fault_t;

typedef struct {
    const char *name;
    bool lasts;                     /* a state, takes MS; the others happen once */
    bool on_bus;                    /* with p: it begins at a random byte of the transfer that follows the sample */
    bool detectable;                /* false: alters a value inside a well-formed transfer */
    bool axis;                      /* PARAM is x, y or z */
    int32_t lowest, usual, highest; /* PARAM; all 0: takes none */
    bool left;                      /* PARAM is what remains of an EEPROM byte */
} kind_properties_t;

extern const kind_properties_t fault_kinds[KIND_COUNT];

/* Fills *fault from WHEN:KIND[:PARAM][:MS]; exits with EXIT_INPUT and the reason. */
void fault_parse(fault_t *fault, const char *text);

#endif
