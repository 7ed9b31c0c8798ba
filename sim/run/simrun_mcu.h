/* The ATmega328P with its program loaded. Time is mcu->cycle, CYCLES_PER_US per microsecond, from the start. */
#ifndef SIMRUN_MCU_H
#define SIMRUN_MCU_H

#include <stdbool.h>
#include <stdint.h>

#include "sim_avr.h"
#include "simrun_symbols.h"

#define CYCLES_PER_US mcu_program.cycles_per_us
#define CYCLES_PER_MS (mcu_program.cycles_per_us * 1000u)
#define NEVER UINT64_MAX

enum { RAM_START = 0x100, RAM_END = 0x8FF, FLASH_BYTES = 0x8000, FLASH_WORDS = FLASH_BYTES / 2, OPCODE_SLEEP = 0x9588 };

typedef struct {
    const char *fw, *bootloader; /* NULL: none */
    bool blank;                  /* the flash holds the boot loader alone */
    bool strap;                  /* D4 is at ground */
    uint32_t seed;
} mcu_options_t;

extern avr_t *mcu;
extern program_size_t mcu_program;

/* Loads the firmware and the boot loader and builds the MCU. Exits with EXIT_INPUT on a bad file. */
void mcu_start(const mcu_options_t *wanted);
/* After a reset: simavr clears what the strap's pin reads, but not the state of its line. */
void mcu_forget_strap(void);
void mcu_poll_no_levels(void); /* after each reset */

double mcu_ms(void);
unsigned mcu_opcode_at(uint32_t pc); /* byte address */
uint16_t mcu_stack_pointer(void);
bool mcu_in_boot_loader(uint32_t pc); /* byte address; false without a boot loader */
uint32_t mcu_random(void);            /* xorshift32 from the seed */

#endif
