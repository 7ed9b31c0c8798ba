/* The slave's side of the two lines, bit by bit; part of twi_peripheral.c. */
#ifndef TWI_SLAVE_H
#define TWI_SLAVE_H

#include "twi_peripheral.h"

enum { PIN_SDA = 4, PIN_SCL = 5 }; /* of port C */

/* In a read: what the slave puts out in the next clock, true for a one; `pulled`: somebody else holds SDA low in it. */
bool twi_slave_bit(twi_peripheral_t *twi, bool pulled);

/* So many clocks in which nobody looks at what the slave puts out. */
void twi_slave_move(twi_peripheral_t *twi, unsigned clocks);

/* SDA is low for so many clocks, 1..16, before the slave goes on. */
void twi_slave_hang(twi_peripheral_t *twi, unsigned clocks);

/* The master has gone; the slave did not notice and still wants to put out the rest of its byte. */
void twi_slave_left(twi_peripheral_t *twi);

/* A START or STOP: the slave is in no byte. */
void twi_slave_released(twi_peripheral_t *twi);

/* With the TWI off the firmware pulls lines by its pins (bits of port C): clock, START or STOP. */
void twi_slave_by_hand(twi_peripheral_t *twi, uint8_t pulled_before, uint8_t pulled_now);

#endif
