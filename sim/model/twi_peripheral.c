/* The registers are taken over through simavr's public table of I/O callbacks; these three have no second user. */
#include "twi_peripheral.h"

#include <stddef.h>

#include "sim_cycle_timers.h"
#include "sim_interrupts.h"
#include "sim_io.h"
#include "twi_pins.h"
#include "twi_slave.h"
#include "twi_wires.h"

enum {
    REG_TWDR = 0xBB,
    REG_TWCR = 0xBC,
    VECTOR_TWI = 24,
    BIT_TWIE = 0x01,
    BIT_TWEN = 0x04,
    BIT_TWWC = 0x08,
    BIT_TWSTO = 0x10,
    BIT_TWSTA = 0x20,
    BIT_TWEA = 0x40,
    BIT_TWINT = 0x80
};

enum {
    STATUS_BUS_ERROR = 0x00,
    STATUS_START = 0x08,
    STATUS_REPEATED_START = 0x10,
    STATUS_SLA_W_ACK = 0x18,
    STATUS_SLA_W_NACK = 0x20,
    STATUS_SENT_ACK = 0x28,
    STATUS_SENT_NACK = 0x30,
    STATUS_ARBITRATION_LOST = 0x38,
    STATUS_SLA_R_ACK = 0x40,
    STATUS_SLA_R_NACK = 0x48,
    STATUS_RECEIVED_ACK = 0x50,
    STATUS_RECEIVED_NACK = 0x58,
    STATUS_NOTHING = 0xF8
};

enum { BITS_START = 1, BITS_STOP = 1, BITS_BYTE = 9, BITS_UNTIL_LOST = 4, BITS_UNTIL_ERROR = 3, BITS_UNTIL_ZERO = 2 };

static bool lines_free(const twi_peripheral_t *twi)
{
    return !twi_sda_low(twi) && !twi_scl_low(twi);
}

static void set_status(twi_peripheral_t *twi, uint8_t status)
{
    uint8_t prescaler = twi->avr->data[REG_TWSR] & PRESCALER_MASK;
    twi->avr->data[REG_TWSR] = (uint8_t)(prescaler | status);
}

static avr_cycle_count_t on_done(avr_t *avr, avr_cycle_count_t when, void *param)
{
    (void)when;
    twi_peripheral_t *twi = param;
    twi->done_at = 0;
    set_status(twi, twi->next_status);
    avr_raise_interrupt(avr, twi->vector);
    return 0;
}

static void run_for(twi_peripheral_t *twi, uint64_t cycles)
{
    twi->done_at = twi->avr->cycle + cycles;
    avr_cycle_timer_register(twi->avr, cycles, on_done, twi);
}

static bool under_way(const twi_peripheral_t *twi)
{
    return twi->done_at != 0 || twi->stalled_cycles != 0;
}

/* Sets TWINT after this many bits, with this status; never while SCL is held low. */
static void finish_in(twi_peripheral_t *twi, unsigned bits, uint8_t status)
{
    twi->bit_cycles = twi_wires_bit_cycles(twi);
    uint64_t cycles = (uint64_t)bits * twi->bit_cycles;
    twi->next_status = status;
    twi->busy_cycles += cycles;
    if (twi_scl_low(twi)) {
        twi->stalled_cycles = cycles;
        return;
    }
    run_for(twi, cycles);
}

static void send_start(twi_peripheral_t *twi)
{
    bool repeated = twi->mode == TWI_STARTED || twi->mode == TWI_TRANSMITTING || twi->mode == TWI_RECEIVING;
    twi->start_waits = false;
    twi_slave_released(twi);
    twi->mode = TWI_STARTED;
    twi->byte_bits = 0xFFFF;
    if (!repeated) {
        twi->transfer++;
        twi->byte = 0;
    }
    finish_in(twi, BITS_START, repeated ? STATUS_REPEATED_START : STATUS_START);
}

/* A START waits for a free bus, indefinitely. */
static void want_start(twi_peripheral_t *twi)
{
    if (lines_free(twi)) {
        send_start(twi);
    } else {
        twi->start_waits = true;
    }
}

static avr_cycle_count_t on_stopped(avr_t *avr, avr_cycle_count_t when, void *param)
{
    (void)when;
    twi_peripheral_t *twi = param;
    if (!lines_free(twi)) {
        return 0; /* TWSTO stays set until twi_hold resumes it */
    }
    avr->data[REG_TWCR] &= (uint8_t)~BIT_TWSTO;
    twi->mode = TWI_IDLE;
    twi_slave_released(twi);
    adxl345_model_stop(twi->sensor);
    if (twi->start_waits) {
        send_start(twi);
    }
    return 0;
}

static void want_stop(twi_peripheral_t *twi)
{
    set_status(twi, STATUS_NOTHING);
    bool on_bus = twi->mode != TWI_IDLE && twi->mode != TWI_FAILED;
    if (!on_bus) {
        twi->avr->data[REG_TWCR] &= (uint8_t)~BIT_TWSTO;
        twi->mode = TWI_IDLE;
        return;
    }
    unsigned cycles = twi_wires_stop_cycles(twi);
    twi->busy_cycles += cycles;
    avr_cycle_timer_register(twi->avr, cycles, on_stopped, twi);
}

static void lose(twi_peripheral_t *twi, unsigned bits)
{
    twi_slave_left(twi);
    twi->mode = TWI_IDLE;
    adxl345_model_stop(twi->sensor);
    finish_in(twi, bits, STATUS_ARBITRATION_LOST);
}

/* The slave's response to an address or data byte; a requested NACK happens once. */
static bool slave_acknowledges(twi_peripheral_t *twi, bool is_address, uint8_t byte)
{
    bool *nack = is_address ? &twi->nack_address : &twi->nack_data;
    bool refused = *nack;
    *nack = false;
    if (refused) {
        return false;
    }
    return is_address ? adxl345_model_start(twi->sensor, byte) : adxl345_model_write(twi->sensor, byte);
}

static bool one_reads_zero(const twi_peripheral_t *twi)
{
    return twi_sda_low(twi) || twi_wires_master_late(twi);
}

/* Address or data to the slave. */
static void send_byte(twi_peripheral_t *twi)
{
    uint8_t byte = twi->avr->data[REG_TWDR];
    bool is_address = twi->mode == TWI_STARTED;
    bool lost = byte != 0 && one_reads_zero(twi); /* the master gives no further clock */
    twi_slave_move(twi, lost ? BITS_UNTIL_ZERO : BITS_BYTE);
    if (lost) {
        lose(twi, BITS_UNTIL_ZERO);
        return;
    }
    bool ack = slave_acknowledges(twi, is_address, byte);
    twi->acknowledged = ack;
    twi->byte_bits = ack ? 0xFF7F : 0xFFFF; /* the master drives eight bits, the slave pulls the acknowledge */
    if (!is_address) {
        finish_in(twi, BITS_BYTE, ack ? STATUS_SENT_ACK : STATUS_SENT_NACK);
    } else if ((byte & 1u) != 0) {
        twi->mode = TWI_RECEIVING;
        finish_in(twi, BITS_BYTE, ack ? STATUS_SLA_R_ACK : STATUS_SLA_R_NACK);
    } else {
        twi->mode = TWI_TRANSMITTING;
        finish_in(twi, BITS_BYTE, ack ? STATUS_SLA_W_ACK : STATUS_SLA_W_NACK);
    }
}

/* What the slave puts on the line in nine clocks; the master pulls SDA low in the last one if it acknowledges. */
static void receive_byte(twi_peripheral_t *twi, bool give_ack)
{
    unsigned bits = 0;
    unsigned wire = 0;
    bool was_one = false; /* the preceding acknowledge was low */
    twi->acknowledged = twi->acknowledged && !twi->let_go;
    twi->let_go = false;
    for (unsigned clock = 1; clock <= BITS_BYTE; clock++) {
        bool pulled = twi->sda_held || (clock == BITS_BYTE && give_ack);
        bool one = twi_slave_bit(twi, pulled);
        bool is_one = one && !pulled;
        bits = bits << 1 | one;
        wire = wire << 1 | (is_one && twi_wires_in_time(twi, clock, was_one));
        was_one = is_one;
    }
    twi->byte_bits = (uint16_t)(bits << (16 - BITS_BYTE));
    if (!give_ack && (wire & 1u) == 0) {
        lose(twi, BITS_BYTE); /* the NACK reads as ACK */
        return;
    }
    twi->avr->data[REG_TWDR] = (uint8_t)(wire >> 1);
    finish_in(twi, BITS_BYTE, give_ack ? STATUS_RECEIVED_ACK : STATUS_RECEIVED_NACK);
}

static void next_byte(twi_peripheral_t *twi, bool give_ack)
{
    twi->byte++;
    twi->bytes++;
    if (twi->before_byte != NULL) {
        twi->before_byte(twi->owner, twi->transfer, twi->byte);
    }
    if (twi->lose_arbitration) {
        twi->lose_arbitration = false;
        lose(twi, BITS_UNTIL_LOST);
    } else if (twi->bus_error) {
        twi->bus_error = false;
        adxl345_model_stop(twi->sensor);
        twi->mode = TWI_FAILED;
        finish_in(twi, BITS_UNTIL_ERROR, STATUS_BUS_ERROR);
    } else if (twi->mode == TWI_RECEIVING) {
        receive_byte(twi, give_ack);
    } else {
        send_byte(twi);
    }
    if (twi->after_byte != NULL) {
        twi->after_byte(twi->owner);
    }
}

/* The slave does not notice that the master is gone: it stays within its byte, driving the bit it has reached. */
static void leave_slave_in_byte(twi_peripheral_t *twi)
{
    bool addressed = twi->mode == TWI_RECEIVING || twi->mode == TWI_TRANSMITTING;
    if (!under_way(twi) || !addressed) {
        twi_slave_left(twi);
        return;
    }
    uint64_t left = twi->stalled_cycles;
    if (twi->done_at > twi->avr->cycle) {
        left = twi->done_at - twi->avr->cycle;
    }
    uint64_t bits_gone = BITS_BYTE - (left + twi->bit_cycles - 1) / twi->bit_cycles;
    bool slave_sends = twi->next_status == STATUS_RECEIVED_ACK || twi->next_status == STATUS_RECEIVED_NACK;
    if (slave_sends || bits_gone == BITS_BYTE - 1) {
        twi->slave_bits = (uint16_t)(twi->byte_bits << bits_gone);
        twi->slave_bit_count = (uint8_t)(BITS_BYTE - bits_gone);
    }
}

static void turn_off(twi_peripheral_t *twi)
{
    avr_cycle_timer_cancel(twi->avr, on_done, twi);
    avr_cycle_timer_cancel(twi->avr, on_stopped, twi);
    leave_slave_in_byte(twi);
    twi->vector->pending = 0;
    twi->mode = TWI_OFF;
    twi->hand_clocks = 0;
    twi->start_waits = false;
    twi->done_at = 0;
    twi->stalled_cycles = 0;
    set_status(twi, STATUS_NOTHING);
    twi_pins_show(twi);
}

static void go_on(twi_peripheral_t *twi, uint8_t control)
{
    if (control & BIT_TWSTO) {
        bool on_bus = twi->mode != TWI_IDLE && twi->mode != TWI_FAILED;
        want_stop(twi);
        if (control & BIT_TWSTA) {
            twi->start_waits = true;
        }
        if (!on_bus && twi->start_waits) {
            want_start(twi);
        }
    } else if (control & BIT_TWSTA) {
        want_start(twi);
    } else if (twi->mode != TWI_IDLE && twi->mode != TWI_FAILED) {
        next_byte(twi, (control & BIT_TWEA) != 0);
    }
}

static void write_twcr(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    twi_peripheral_t *twi = param;
    uint8_t before = avr->data[REG_TWCR];
    bool clears_flag = (value & BIT_TWINT) != 0;
    unsigned flag = clears_flag ? 0u : before & BIT_TWINT;
    unsigned kept = value & (BIT_TWEA | BIT_TWSTA | BIT_TWSTO | BIT_TWEN | BIT_TWIE);
    avr_core_watch_write(avr, address, (uint8_t)(kept | flag | (before & BIT_TWWC)));
    if (!(value & BIT_TWEN)) {
        turn_off(twi);
        avr->data[REG_TWCR] = value & BIT_TWIE;
        return;
    }
    if (twi->mode == TWI_OFF) {
        twi->mode = TWI_IDLE;
    }
    if (clears_flag) {
        twi->vector->pending = 0;
        go_on(twi, value);
    } else if (flag != 0 && (value & BIT_TWIE) && !(before & BIT_TWIE)) {
        avr_raise_interrupt(avr, twi->vector);
    }
}

/* While a byte is in progress TWDR cannot be loaded. */
static void write_twdr(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    twi_peripheral_t *twi = param;
    if (avr->data[REG_TWCR] & BIT_TWINT) {
        avr->data[REG_TWCR] &= (uint8_t)~BIT_TWWC;
    } else {
        avr->data[REG_TWCR] |= BIT_TWWC;
    }
    if (!under_way(twi)) {
        avr_core_watch_write(avr, address, value);
    }
}

static void write_twsr(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    (void)param;
    unsigned status = avr->data[address] & (0xFFu ^ PRESCALER_MASK);
    avr_core_watch_write(avr, address, (uint8_t)(status | (value & PRESCALER_MASK)));
}

static void lines_changed(twi_peripheral_t *twi)
{
    twi_pins_show(twi);
    if (twi->mode == TWI_OFF) {
        return;
    }
    if (!twi_scl_low(twi) && twi->stalled_cycles != 0) {
        run_for(twi, twi->stalled_cycles);
        twi->stalled_cycles = 0;
    }
    bool stop_waits = (twi->avr->data[REG_TWCR] & BIT_TWSTO) != 0;
    if (!lines_free(twi)) {
        return;
    }
    if (stop_waits && avr_cycle_timer_status(twi->avr, on_stopped, twi) == 0) {
        avr_cycle_timer_register(twi->avr, twi_wires_stop_cycles(twi), on_stopped, twi);
    } else if (!stop_waits && twi->start_waits) {
        send_start(twi);
    }
}

void twi_hold(twi_peripheral_t *twi, bool sda, bool scl)
{
    if (scl && !twi->scl_held && twi->done_at != 0) {
        uint64_t now = twi->avr->cycle;
        twi->stalled_cycles = twi->done_at > now ? twi->done_at - now : 1;
        twi->done_at = 0;
        avr_cycle_timer_cancel(twi->avr, on_done, twi);
    }
    twi->sda_held = sda;
    twi->scl_held = scl;
    lines_changed(twi);
}

void twi_hang(twi_peripheral_t *twi, unsigned clocks)
{
    twi_slave_hang(twi, clocks);
    lines_changed(twi);
}

void twi_reset(twi_peripheral_t *twi)
{
    twi_pins_reset(twi);
    turn_off(twi);
    twi->avr->data[REG_TWCR] = 0;
    twi->avr->data[REG_TWSR] = STATUS_NOTHING;
    twi->avr->data[REG_TWDR] = 0xFF;
}

bool twi_attach(twi_peripheral_t *twi, avr_t *avr)
{
    twi->avr = avr;
    for (int i = 0; i < avr->interrupts.vector_count; i++) {
        if (avr->interrupts.vector[i]->vector == VECTOR_TWI) {
            twi->vector = avr->interrupts.vector[i];
        }
    }
    if (twi->vector == NULL) {
        return false;
    }
    avr->io[AVR_DATA_TO_IO(REG_TWCR)].w.c = write_twcr;
    avr->io[AVR_DATA_TO_IO(REG_TWCR)].w.param = twi;
    avr->io[AVR_DATA_TO_IO(REG_TWDR)].w.c = write_twdr;
    avr->io[AVR_DATA_TO_IO(REG_TWDR)].w.param = twi;
    avr->io[AVR_DATA_TO_IO(REG_TWDR)].r.c = NULL;
    avr->io[AVR_DATA_TO_IO(REG_TWSR)].w.c = write_twsr;
    avr->io[AVR_DATA_TO_IO(REG_TWSR)].w.param = twi;
    twi_pins_attach(twi);
    twi_reset(twi);
    return true;
}
