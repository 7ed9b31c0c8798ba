/* The slave's side of the two lines, bit by bit; part of twi_peripheral.c. */
#ifndef TWI_SLAVE_H
#define TWI_SLAVE_H

#include "twi_peripheral.h"

enum { PIN_SDA = 4, PIN_SCL = 5 }; /* of port C */

/* In a read: what the slave sends in the next clock, true for a one; `pulled`: SDA is held low from elsewhere in it. */
bool twi_slave_bit(twi_peripheral_t *twi, bool pulled);

/* Clocks during which the slave's output is ignored. */
void twi_slave_move(twi_peripheral_t *twi, unsigned clocks);

/* SDA is low for this many clocks, 1..16, before the slave continues. */
void twi_slave_hang(twi_peripheral_t *twi, unsigned clocks);

/* The master is gone; the slave did not notice and still has to send the rest of its byte. */
void twi_slave_left(twi_peripheral_t *twi);

/* A START or STOP: the slave is not within a byte. */
void twi_slave_released(twi_peripheral_t *twi);

/* With the TWI off the firmware drives the lines by its pins (bits of port C): clock, START or STOP. */
void twi_slave_by_hand(twi_peripheral_t *twi, uint8_t pulled_before, uint8_t pulled_now);

#endif
