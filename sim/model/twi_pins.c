#include "twi_pins.h"

#include "avr_ioport.h"
#include "sim_cycle_timers.h"
#include "twi_slave.h"
#include "twi_wires.h"

enum { REG_PINC = 0x26, REG_PORTC = 0x28 };

static bool rising(const twi_peripheral_t *twi, uint64_t up_at)
{
    return twi->avr->cycle < up_at;
}

void twi_pins_show(twi_peripheral_t *twi)
{
    bool sda = !twi_sda_low(twi) && !rising(twi, twi->sda_up_at);
    bool scl = !twi_scl_low(twi) && !rising(twi, twi->scl_up_at);
    avr_ioport_external_t pull = { .name = 'C',
                                   .mask = (1u << PIN_SDA) | (1u << PIN_SCL),
                                   .value = (sda ? 1u << PIN_SDA : 0u) | (scl ? 1u << PIN_SCL : 0u) };
    avr_ioctl(twi->avr, AVR_IOCTL_IOPORT_SET_EXTERNAL('C'), &pull);
    avr_raise_irq(twi->pin_sda, sda);
    avr_raise_irq(twi->pin_scl, scl);
    uint8_t others = twi->avr->data[REG_PINC] & (uint8_t)~pull.mask;
    twi->avr->data[REG_PINC] = (uint8_t)(others | pull.value); /* the IRQs above are silent if the level is unchanged */
}

static avr_cycle_count_t on_sda_up(avr_t *avr, avr_cycle_count_t when, void *param)
{
    (void)avr;
    (void)when;
    twi_pins_show(param);
    return 0;
}

/* A function separate from SDA's: simavr has one timer per function. */
static avr_cycle_count_t on_scl_up(avr_t *avr, avr_cycle_count_t when, void *param)
{
    return on_sda_up(avr, when, param);
}

/* The firmware's own pins release these lines, bits of port C. */
static void let_go(twi_peripheral_t *twi, unsigned lines)
{
    unsigned sda = twi_wires_sda_cycles(twi), scl = twi_wires_scl_cycles(twi);
    if ((lines & (1u << PIN_SDA)) != 0 && sda != 0) {
        twi->sda_up_at = twi->avr->cycle + sda;
        avr_cycle_timer_register(twi->avr, sda, on_sda_up, twi);
    }
    if ((lines & (1u << PIN_SCL)) != 0 && scl != 0) {
        twi->scl_up_at = twi->avr->cycle + scl;
        avr_cycle_timer_register(twi->avr, scl, on_scl_up, twi);
    }
}

/* While the TWI is off the lines follow DDRC: low outputs pull, inputs release. */
static void on_direction(avr_irq_t *irq, uint32_t value, void *param)
{
    (void)irq;
    twi_peripheral_t *twi = param;
    unsigned lines = (1u << PIN_SDA) | (1u << PIN_SCL);
    uint8_t high = twi->avr->data[REG_PORTC];
    uint8_t before = twi->pulled;
    twi->pulled = (uint8_t)(value & lines & ~(unsigned)high);
    twi->driven_high = twi->driven_high || (value & high & lines) != 0;
    if (twi->mode == TWI_OFF && before != twi->pulled) {
        let_go(twi, before & ~(unsigned)twi->pulled);
        twi_slave_by_hand(twi, before, twi->pulled);
        twi_pins_show(twi);
    }
}

void twi_pins_attach(twi_peripheral_t *twi)
{
    twi->pin_sda = avr_io_getirq(twi->avr, AVR_IOCTL_IOPORT_GETIRQ('C'), PIN_SDA);
    twi->pin_scl = avr_io_getirq(twi->avr, AVR_IOCTL_IOPORT_GETIRQ('C'), PIN_SCL);
    avr_irq_t *direction = avr_io_getirq(twi->avr, AVR_IOCTL_IOPORT_GETIRQ('C'), IOPORT_IRQ_DIRECTION_ALL);
    avr_irq_register_notify(direction, on_direction, twi);
}

void twi_pins_reset(twi_peripheral_t *twi)
{
    twi->pulled = 0;
    twi->sda_up_at = 0;
    twi->scl_up_at = 0;
}
