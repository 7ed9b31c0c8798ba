/* SDA and SCL as the firmware's pins see and drive them; part of twi_peripheral.c. */
#ifndef TWI_PINS_H
#define TWI_PINS_H

#include "twi_peripheral.h"

/* What the pins read as inputs. Call after every change of the lines. */
void twi_pins_show(twi_peripheral_t *twi);

/* Once: while the TWI is off, the lines follow the firmware's DDRC. */
void twi_pins_attach(twi_peripheral_t *twi);

/* A reset of the MCU: the pins are inputs. */
void twi_pins_reset(twi_peripheral_t *twi);

#endif
