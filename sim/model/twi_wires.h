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

enum { REG_TWBR = 0xB8, REG_TWSR = 0xB9, PRESCALER_MASK = 0x03 }; /* the bit rate */

/* Cycles until a released line is seen high. */
unsigned twi_wires_scl_cycles(const twi_peripheral_t *twi);
unsigned twi_wires_sda_cycles(const twi_peripheral_t *twi);

/* Cycles of a bit, at the TWBR and TWPS in force, and of a STOP. */
unsigned twi_wires_bit_cycles(const twi_peripheral_t *twi);
unsigned twi_wires_stop_cycles(const twi_peripheral_t *twi);

/* A one that the master sends after a zero is not up in time. */
bool twi_wires_master_late(const twi_peripheral_t *twi);

/* A one in this clock of a byte being read, 1..9, is up in time; the ninth is the master's. */
bool twi_wires_in_time(const twi_peripheral_t *twi, unsigned clock, bool after_one);

#endif
