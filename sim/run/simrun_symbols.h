/* Function names, sizes and _end from the firmware's ELF file. */
#ifndef SIMRUN_SYMBOLS_H
#define SIMRUN_SYMBOLS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    uint32_t end_of_ram;    /* _end: first free RAM address */
    uint32_t code_bytes;    /* .text */
    uint32_t flash_bytes;   /* .text and .data */
    uint32_t cycles_per_us; /* the processor's clock in MHz: 16, or the value of the symbol cpu_hz */
} program_size_t;

void symbols_load(const char *path, program_size_t *size);
/* Byte address of a function, with or without the compiler's suffix (.lto_priv.0); false if there is none. */
bool symbols_find(const char *name, uint32_t *pc);
/* Address in data space of a variable of the firmware. */
bool symbols_find_variable(const char *name, uint32_t *address);
/* "name+0x12" of the function that contains pc; static text. */
const char *symbols_nearest(uint32_t pc);
const char *symbols_variable_at(uint32_t address); /* the same for the variable at an address in data space */

#endif
