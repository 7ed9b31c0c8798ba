/*
 * The ATmega328P's two-wire interface as a bus master, in place of simavr 1.6's (which reports wrong status codes,
 * ignores TWBR and cannot be polled). Source: ATmega328P data sheet, chapter "2-wire Serial Interface", status codes in
 * Tables 22-2 and 22-3. Slave mode and other masters are not modelled, except as faults.
 *
 * Times: START and STOP one bit, a byte with its acknowledge nine; a bit is 16 + 2 TWBR 4^TWPS cycles and SCL's rise
 * (twi_wires.h), a STOP SDA's besides.
 * Levels of PC4 (SDA) and PC5 (SCL) as read by the firmware follow a line held low from outside, by the slave or by its
 * own DDRC; the TWI's own traffic is not shown on them.
 */
#ifndef TWI_PERIPHERAL_H
#define TWI_PERIPHERAL_H

#include <stdbool.h>
#include <stdint.h>

#include "adxl345_model.h"
#include "sim_avr.h"

typedef enum {
    TWI_OFF,
    TWI_IDLE,    /* enabled, not master of the bus */
    TWI_STARTED, /* the next byte is an address */
    TWI_TRANSMITTING,
    TWI_RECEIVING,
    TWI_FAILED /* after a bus error: only TWSTO leads out */
} twi_mode_t;

typedef struct {
    /* set by the owner before twi_attach */
    adxl345_model_t *sensor;
    void (*before_byte)(void *owner, uint32_t transfer,
                        uint32_t byte); /* transfer from 1; byte 1 is the address; may be NULL */
    void (*after_byte)(void *owner);    /* the sensor has received a byte: its rate may have changed; may be NULL */
    uint8_t (*sent)(void *owner, uint8_t address, uint8_t byte); /* register and byte that the sensor puts on the
                                                                    wire; returns what arrives; may be NULL */
    void *owner;
    double rise_sda_ns, rise_scl_ns; /* from 0 to where an input sees a one; 0: at once */

    /* faults that happen once, in the next byte that can show them */
    bool lose_arbitration, bus_error, nack_address, nack_data;
    bool let_go; /* the slave stops sending in this read: ones */

    avr_t *avr;
    avr_int_vector_t *vector;
    avr_irq_t *pin_sda, *pin_scl;
    twi_mode_t mode;
    uint8_t next_status;
    bool start_waits;        /* TWSTA set while the bus was not free */
    bool acknowledged;       /* the slave still listens or sends */
    bool sda_held, scl_held; /* from outside, twi_hold */
    uint16_t slave_bits;     /* bits that a lagging slave sends before anything else, next bit at bit 15 */
    uint8_t slave_bit_count; /* number of them */
    uint8_t slave_byte;      /* byte that it is sending */
    uint8_t slave_place;     /* bits of it already sent, 8: the acknowledge is next */
    uint64_t done_at;        /* cycle at which the current bit or byte ends, 0: none */
    unsigned bit_cycles;     /* of that bit or byte */
    uint16_t byte_bits;      /* that byte as the slave drives it: eight bits and the acknowledge, from bit 15 */
    uint64_t stalled_cycles; /* left of the bit or byte that SCL held low has suspended; 0: none */
    uint8_t pulled;          /* by the firmware's own pins, bits of port C */
    uint32_t hand_clocks;    /* sent by hand since the TWI was turned off */
    uint32_t hand_clocks_max, hand_stops;
    bool driven_high;        /* SDA or SCL was made an output that is high */
    uint32_t transfer, byte; /* transfers begun; bytes in this one */
    uint64_t bytes, busy_cycles;
    uint64_t sda_up_at, scl_up_at; /* cycles at which released lines are seen high; twi_pins.c */
} twi_peripheral_t;

/* Takes over TWCR, TWDR and TWSR of this MCU. False if it has no TWI vector. */
bool twi_attach(twi_peripheral_t *twi, avr_t *avr);

/*
 * After every reset of the MCU (simavr has dropped all timers): registers at reset; a slave in the middle of a byte
 * stays there.
 */
void twi_reset(twi_peripheral_t *twi);

/* Holds lines low from outside, or releases them: what was waiting for a free line continues. */
void twi_hold(twi_peripheral_t *twi, bool sda, bool scl);

/*
 * A slave hangs within a byte: SDA is low until this many more clocks have come, 1..16. It then continues with the bit
 * at which it stopped, so that what the master reads from there on is shifted. START and STOP end that, also if made by
 * hand.
 */
void twi_hang(twi_peripheral_t *twi, unsigned clocks);

/* Levels on the wires when no master pulls. */
bool twi_sda_low(const twi_peripheral_t *twi);
bool twi_scl_low(const twi_peripheral_t *twi);

#endif
