/* EEPROM, one byte at a time. A write takes 3.4 ms (data sheet p. 22) and runs in the background. */
#ifndef HAL_EEPROM_H
#define HAL_EEPROM_H

#include <stdbool.h>
#include <stdint.h>

#define HAL_EEPROM_SIZE 1024u

/* No write is in progress. Main. */
bool hal_eeprom_ready(void);

/* The byte at address, 0 to HAL_EEPROM_SIZE - 1. Only when ready. Main. */
uint8_t hal_eeprom_read(uint16_t address);

/* Starts writing the byte at address, 0 to HAL_EEPROM_SIZE - 1, and returns at once. Only when ready. Main. */
void hal_eeprom_write_start(uint16_t address, uint8_t value);

#endif
