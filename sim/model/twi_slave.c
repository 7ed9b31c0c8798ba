/* A slave changes SDA after SCL has fallen; a change of SDA while SCL is high is START or STOP (UM10204, 3.1.4). */
#include "twi_slave.h"

#include <stddef.h>

enum { BITS_DATA = 8, QUEUE_BITS = 16 };

static bool queue_is_low(const twi_peripheral_t *twi)
{
    return (twi->slave_bits & 0x8000u) == 0;
}

static bool in_byte(const twi_peripheral_t *twi)
{
    return twi->mode == TWI_RECEIVING && twi->acknowledged && twi->slave_place != 0 && twi->slave_place < BITS_DATA;
}

static bool bit_of_byte(const twi_peripheral_t *twi)
{
    return (twi->slave_byte >> (BITS_DATA - 1u - twi->slave_place) & 1u) != 0;
}

static bool slave_low(const twi_peripheral_t *twi)
{
    return twi->slave_bit_count != 0 ? queue_is_low(twi) : in_byte(twi) && !bit_of_byte(twi);
}

bool twi_sda_low(const twi_peripheral_t *twi)
{
    return twi->sda_held || slave_low(twi);
}

bool twi_scl_low(const twi_peripheral_t *twi)
{
    return twi->scl_held;
}

void twi_slave_move(twi_peripheral_t *twi, unsigned clocks)
{
    while (clocks != 0 && twi->slave_bit_count != 0) {
        twi->slave_bits = (uint16_t)(twi->slave_bits << 1);
        twi->slave_bit_count--;
        clocks--;
    }
}

static uint8_t next_byte(const twi_peripheral_t *twi)
{
    uint8_t address = twi->sensor->pointer;
    uint8_t byte = adxl345_model_read(twi->sensor);
    return twi->sent == NULL ? byte : twi->sent(twi->owner, address, byte);
}

bool twi_slave_bit(twi_peripheral_t *twi, bool pulled)
{
    if (twi->slave_bit_count != 0) {
        bool one = !queue_is_low(twi);
        twi_slave_move(twi, 1);
        return one;
    }
    if (!twi->acknowledged) {
        return true;
    }
    if (twi->slave_place == BITS_DATA) {
        twi->slave_place = 0;
        twi->acknowledged = pulled;
        return true;
    }
    if (twi->slave_place == 0) {
        twi->slave_byte = next_byte(twi);
    }
    bool one = bit_of_byte(twi);
    twi->slave_place++;
    return one;
}

void twi_slave_hang(twi_peripheral_t *twi, unsigned clocks)
{
    twi->slave_bits = 0;
    twi->slave_bit_count = (uint8_t)(clocks > QUEUE_BITS ? QUEUE_BITS : clocks);
}

void twi_slave_left(twi_peripheral_t *twi)
{
    if (twi->slave_bit_count == 0 && in_byte(twi)) {
        twi->slave_bits = (uint16_t)(((unsigned)twi->slave_byte << BITS_DATA | 0x80u) << twi->slave_place);
        twi->slave_bit_count = (uint8_t)(BITS_DATA + 1u - twi->slave_place);
    }
    twi->slave_place = 0;
    twi->acknowledged = false;
}

void twi_slave_released(twi_peripheral_t *twi)
{
    twi->slave_bit_count = 0;
    twi->slave_place = 0;
}

void twi_slave_by_hand(twi_peripheral_t *twi, uint8_t pulled_before, uint8_t pulled_now)
{
    unsigned low = (unsigned)twi->scl_held << PIN_SCL | (unsigned)twi_sda_low(twi) << PIN_SDA;
    bool scl_was_high = ((low | pulled_before) & (1u << PIN_SCL)) == 0;
    bool scl_is_high = ((low | pulled_now) & (1u << PIN_SCL)) == 0;
    bool sda_was_high = ((low | pulled_before) & (1u << PIN_SDA)) == 0;
    bool sda_is_high = ((low | pulled_now) & (1u << PIN_SDA)) == 0;
    if (scl_was_high && !scl_is_high) {
        twi_slave_move(twi, 1);
        twi->hand_clocks++;
        twi->hand_clocks_max = twi->hand_clocks > twi->hand_clocks_max ? twi->hand_clocks : twi->hand_clocks_max;
    }
    if (scl_was_high && scl_is_high && sda_was_high != sda_is_high) {
        twi_slave_released(twi);
        adxl345_model_stop(twi->sensor);
        twi->hand_stops += sda_is_high;
    }
}
