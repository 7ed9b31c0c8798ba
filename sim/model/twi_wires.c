#include "twi_wires.h"

#define MASTER_VALID_NS 300.0
#define SLAVE_VALID_NS 900.0
#define SETUP_NS 100.0
#define NS_PER_S 1e9

enum { CLOCK_ACKNOWLEDGE = 9 };

static unsigned cycles_of(const twi_peripheral_t *twi, double ns)
{
    return (unsigned)(ns * twi->avr->frequency / NS_PER_S + 0.5);
}

unsigned twi_wires_scl_cycles(const twi_peripheral_t *twi)
{
    return cycles_of(twi, twi->rise_scl_ns);
}

unsigned twi_wires_sda_cycles(const twi_peripheral_t *twi)
{
    return cycles_of(twi, twi->rise_sda_ns);
}

/* Time that SCL is low in each bit; it is high for as long. */
static unsigned half_cycles(const twi_peripheral_t *twi)
{
    const uint8_t *data = twi->avr->data;
    return 8u + data[REG_TWBR] * (1u << (2u * (data[REG_TWSR] & PRESCALER_MASK)));
}

unsigned twi_wires_bit_cycles(const twi_peripheral_t *twi)
{
    return 2u * half_cycles(twi) + twi_wires_scl_cycles(twi);
}

unsigned twi_wires_stop_cycles(const twi_peripheral_t *twi)
{
    return twi_wires_bit_cycles(twi) + twi_wires_sda_cycles(twi);
}

static bool late(const twi_peripheral_t *twi, double valid_ns)
{
    double low_ns = half_cycles(twi) * NS_PER_S / twi->avr->frequency;
    bool rises = twi->rise_sda_ns > 0.0;
    return rises && valid_ns + twi->rise_sda_ns + SETUP_NS > low_ns + twi->rise_scl_ns;
}

bool twi_wires_master_late(const twi_peripheral_t *twi)
{
    return late(twi, MASTER_VALID_NS);
}

bool twi_wires_in_time(const twi_peripheral_t *twi, unsigned clock, bool after_one)
{
    return after_one || !late(twi, clock == CLOCK_ACKNOWLEDGE ? MASTER_VALID_NS : SLAVE_VALID_NS);
}
