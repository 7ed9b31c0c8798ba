/*
 * SDA and SCL with a pull-up and a capacitance: a released line rises late; part of twi_peripheral.c.
 *
 * SCL stretches each bit: the TWI counts its high phase from when it sees the line high (ATmega328P data sheet,
 * arbitration and synchronisation of clocks). A one on SDA must be up 0.1 us before SCL is (UM10204, Table 10). The
 * sensor releases SDA up to 0.9 us after SCL has fallen (ADXL345, p. 18), the master 0.3 us, the minimum that the
 * standard allows. A one that comes later reads as the zero before it; a second one in a row is assumed to be up. Not
 * modelled: lines that fall slowly, thresholds that differ between devices, noise on a slow edge.
 */
#ifndef TWI_WIRES_H
#define TWI_WIRES_H

#include "twi_peripheral.h"

/* Delay until SCL, and after a STOP SDA, is seen high. */
unsigned twi_wires_scl_cycles(const twi_peripheral_t *twi);
unsigned twi_wires_sda_cycles(const twi_peripheral_t *twi);

/* A one that the master sends after a zero is not up in time; SCL is low for low_cycles. */
bool twi_wires_master_late(const twi_peripheral_t *twi, unsigned low_cycles);

/* A one in this clock of a byte being read, 1..9, is up in time; the ninth is the master's. */
bool twi_wires_in_time(const twi_peripheral_t *twi, unsigned low_cycles, unsigned clock, bool after_one);

/* The firmware's own pins release these lines (bits of port C); `seen_high` is called when each has risen. */
void twi_wires_let_go(twi_peripheral_t *twi, unsigned lines, void (*seen_high)(twi_peripheral_t *twi));

/* Released, and not up yet. */
bool twi_wires_sda_rising(const twi_peripheral_t *twi);
bool twi_wires_scl_rising(const twi_peripheral_t *twi);

#endif
