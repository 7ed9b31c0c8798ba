/* Resets of the MCU. */
#ifndef SIMRUN_RESETS_H
#define SIMRUN_RESETS_H

#include <stdbool.h>
#include <stdint.h>

typedef enum { RESET_EXTERNAL, RESET_POWER_ON, RESET_BROWN_OUT } reset_t;

/*
 * Call once every other part has started: from here on resets are detected. set_up: what each reset, and the start,
 * leaves for the parts around the core to do. boot_loader: an opened port resets the MCU.
 */
void resets_start(bool boot_loader, void (*set_up)(bool power_lost));
/* Requested from anywhere, done between two instructions; the last request counts. */
void resets_want(reset_t kind);
bool resets_wanted(void); /* a reset follows this instruction */
/* The pseudo terminal was opened: with a boot loader an external reset, as DTR gives an UNO; not counted. */
void resets_port_opened(void);
/* Between two instructions: counts a reset that happened, does a requested one. last_pc: start of the last step. */
void resets_watch(uint32_t last_pc);
uint32_t resets_count(void);
uint32_t resets_boot_count(void); /* from the boot loader; not counted above */

#endif
