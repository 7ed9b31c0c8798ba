/*
 * EEPROM, 1024 bytes, one byte at a time. A write takes 3.4 ms and goes on by itself.
 *
 *   bool hal_eeprom_ready(void)                              no write under way (main)
 *   uint8_t hal_eeprom_read(uint16_t address)                only when ready (main)
 *   void hal_eeprom_write_start(uint16_t address, uint8_t value)   only when ready; returns at once (main)
 */
#ifndef HAL_EEPROM_H
#define HAL_EEPROM_H

#include <stdbool.h>
#include <stdint.h>

#define HAL_EEPROM_SIZE 1024u

#include "hal_port.h"

#endif
