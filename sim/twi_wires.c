#include "twi_wires.h"

#include "sim_cycle_timers.h"
#include "twi_slave.h"

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

static bool late(const twi_peripheral_t *twi, unsigned low_cycles, double valid_ns)
{
    double low_ns = low_cycles * NS_PER_S / twi->avr->frequency;
    bool rises = twi->rise_sda_ns > 0.0;
    return rises && valid_ns + twi->rise_sda_ns + SETUP_NS > low_ns + twi->rise_scl_ns;
}

bool twi_wires_master_late(const twi_peripheral_t *twi, unsigned low_cycles)
{
    return late(twi, low_cycles, MASTER_VALID_NS);
}

bool twi_wires_in_time(const twi_peripheral_t *twi, unsigned low_cycles, unsigned clock, bool after_one)
{
    return after_one || !late(twi, low_cycles, clock == CLOCK_ACKNOWLEDGE ? MASTER_VALID_NS : SLAVE_VALID_NS);
}

static avr_cycle_count_t on_sda_up(avr_t *avr, avr_cycle_count_t when, void *param)
{
    (void)avr;
    (void)when;
    twi_peripheral_t *twi = param;
    twi->seen_high(twi);
    return 0;
}

/* A function separate from SDA's: simavr has one timer per function. */
static avr_cycle_count_t on_scl_up(avr_t *avr, avr_cycle_count_t when, void *param)
{
    return on_sda_up(avr, when, param);
}

void twi_wires_let_go(twi_peripheral_t *twi, unsigned lines, void (*seen_high)(twi_peripheral_t *twi))
{
    unsigned sda = twi_wires_sda_cycles(twi), scl = twi_wires_scl_cycles(twi);
    twi->seen_high = seen_high;
    if ((lines & (1u << PIN_SDA)) != 0 && sda != 0) {
        twi->sda_up_at = twi->avr->cycle + sda;
        avr_cycle_timer_register(twi->avr, sda, on_sda_up, twi);
    }
    if ((lines & (1u << PIN_SCL)) != 0 && scl != 0) {
        twi->scl_up_at = twi->avr->cycle + scl;
        avr_cycle_timer_register(twi->avr, scl, on_scl_up, twi);
    }
}

bool twi_wires_sda_rising(const twi_peripheral_t *twi)
{
    return twi->avr->cycle < twi->sda_up_at;
}

bool twi_wires_scl_rising(const twi_peripheral_t *twi)
{
    return twi->avr->cycle < twi->scl_up_at;
}
