/* EEPROM of the ATmega328P: EEPE must follow EEMPE within four cycles (data sheet p. 22). */
#include "hal_eeprom.h"

#include <avr/io.h>

#include "hal_irq.h"

bool hal_eeprom_ready(void)
{
    return (EECR & _BV(EEPE)) == 0;
}

uint8_t hal_eeprom_read(uint16_t address)
{
    EEAR = address;
    EECR |= _BV(EERE);
    return EEDR;
}

void hal_eeprom_write_start(uint16_t address, uint8_t value)
{
    EEAR = address;
    EEDR = value;
    hal_irq_state_t state = hal_irq_save();
    EECR |= _BV(EEMPE);
    EECR |= _BV(EEPE);
    hal_irq_restore(state);
}
