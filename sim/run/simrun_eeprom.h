/* The EEPROM: its contents in a file (--eeprom), and the time of a write. */
#ifndef SIMRUN_EEPROM_H
#define SIMRUN_EEPROM_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef enum { EEPROM_IN, EEPROM_BEFORE, EEPROM_AFTER } eeprom_moment_t;
/* Content that a power cycle leaves in the cell being written: erased, the old or the new byte, or junk. */
typedef enum { EEPROM_LEFT_FF, EEPROM_LEFT_OLD, EEPROM_LEFT_NEW, EEPROM_LEFT_RANDOM } eeprom_left_t;

void eeprom_start(const char *path);                                       /* NULL: no file */
void eeprom_on_write(void (*act)(uint32_t count, eeprom_moment_t moment)); /* `act` may request a reset */
void eeprom_finish(void);
void eeprom_reset(bool power_lost);
void eeprom_leave(eeprom_left_t what);
void eeprom_print(FILE *json);
uint64_t eeprom_next(void);
void eeprom_step(void);

#endif
