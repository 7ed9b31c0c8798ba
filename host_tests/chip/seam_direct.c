/* As seam_hal.c, with direct register access. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <stdbool.h>
#include <stdint.h>

#include "seam_bus.h"

enum { GO = _BV(TWINT) | _BV(TWEN) | _BV(TWIE) };

#define STATUS() (uint8_t)(TWSR & 0xF8u)
#define START() (TWCR = GO | _BV(TWSTA))
#define SEND(byte) (TWDR = (byte), TWCR = GO)
#define RECEIVE(ack) (TWCR = (ack) ? (GO | _BV(TWEA)) : GO)
#define RECEIVED() TWDR
#define STOP() (TWCR = _BV(TWINT) | _BV(TWEN) | _BV(TWSTO))

ISR(TWI_vect)
{
#include "seam_body.h"
}
