/* I2C master on the virtual sensor: each command takes its bit times, then reports a status and calls the handler. */
#include "hal_i2c.h"

#include "hal_host_private.h"

enum { BITS_START = 1, BITS_BYTE = 9, CYCLES_PER_PERIOD = 4, CLEAR_CLOCKS_MAX = 16 };

typedef enum { COMMAND_NONE, COMMAND_START, COMMAND_SEND, COMMAND_RECEIVE_ACK, COMMAND_RECEIVE_NACK } command_t;

static struct {
    bool enabled, in_transfer, address_next, reading, stop_pending;
    uint8_t data, status;
    command_t command;
    uint64_t done_at, stop_at;
    unsigned bit_cycles;
} i2c;

static uint32_t hand_clocks;
static uint32_t hand_stops;

void host_i2c_begin(void)
{
    if (i2c.in_transfer) {
        adxl345_model_stop(hal_host_sensor());
    }
    i2c.enabled = false;
    i2c.in_transfer = false;
    i2c.stop_pending = false;
    i2c.command = COMMAND_NONE;
    i2c.done_at = HOST_NEVER;
    i2c.stop_at = HOST_NEVER;
    i2c.status = HAL_I2C_NOTHING;
    i2c.bit_cycles = HAL_I2C_364_KHZ * CYCLES_PER_PERIOD;
}

void host_i2c_power_on(void)
{
    hand_clocks = 0;
    hand_stops = 0;
}

static bool sda_low(void)
{
    return hal_host_faults()->sda_low || hal_host_faults()->hang_clocks != 0;
}

uint64_t host_i2c_next(void)
{
    if (hal_host_faults()->scl_low || sda_low()) {
        return HOST_NEVER;
    }
    uint64_t stop_at = hal_host_faults()->stop_stuck ? HOST_NEVER : i2c.stop_at;
    return i2c.done_at < stop_at ? i2c.done_at : stop_at;
}

static void give(command_t command, unsigned bits)
{
    i2c.command = command;
    uint64_t from = i2c.stop_pending ? i2c.stop_at : hal_host_now();
    i2c.done_at = from + (uint64_t)bits * i2c.bit_cycles;
}

void hal_i2c_enable(uint8_t period_025us)
{
    i2c.enabled = true;
    i2c.bit_cycles = (uint64_t)period_025us * CYCLES_PER_PERIOD;
}

/* The sensor sees the lines released: like a STOP. */
void hal_i2c_disable(void)
{
    unsigned bit_cycles = i2c.bit_cycles;
    host_i2c_begin();
    i2c.bit_cycles = bit_cycles;
}

static uint8_t clock_by_hand(void)
{
    if (hal_host_faults()->scl_low) {
        return HAL_I2C_SCL_LOW;
    }
    for (unsigned clocks = 0; clocks < CLEAR_CLOCKS_MAX; clocks++) {
        hand_clocks++;
        if (hal_host_faults()->hang_clocks != 0) {
            hal_host_faults()->hang_clocks--;
        }
        if (!sda_low()) {
            hand_stops++;
            adxl345_model_stop(hal_host_sensor());
            return HAL_I2C_FREE;
        }
    }
    return HAL_I2C_SDA_LOW;
}

uint8_t hal_i2c_clear(void)
{
    uint8_t lines = clock_by_hand();
    if (host_config()->on_bus_clear != NULL) {
        host_config()->on_bus_clear();
        host_drdy_serve();
    }
    return lines;
}

uint32_t hal_host_hand_clocks(void)
{
    return hand_clocks;
}

uint32_t hal_host_hand_stops(void)
{
    return hand_stops;
}

void hal_i2c_start(void)
{
    i2c.enabled = true;
    give(COMMAND_START, BITS_START);
}

void hal_i2c_send(uint8_t byte)
{
    i2c.data = byte;
    give(COMMAND_SEND, BITS_BYTE);
}

void hal_i2c_receive(bool ack)
{
    give(ack ? COMMAND_RECEIVE_ACK : COMMAND_RECEIVE_NACK, BITS_BYTE);
}

uint8_t hal_i2c_received(void)
{
    return i2c.data;
}

void hal_i2c_stop(void)
{
    i2c.command = COMMAND_NONE;
    i2c.done_at = HOST_NEVER;
    i2c.stop_pending = true;
    i2c.stop_at = hal_host_now() + i2c.bit_cycles;
}

void hal_i2c_release(void)
{
    i2c.command = COMMAND_NONE;
    i2c.done_at = HOST_NEVER;
    i2c.in_transfer = false;
}

uint8_t hal_i2c_status(void)
{
    return i2c.status;
}

bool hal_i2c_stop_pending(void)
{
    if (host_config()->on_stop_asked != NULL) {
        host_config()->on_stop_asked();
        host_drdy_serve();
    }
    return i2c.stop_pending;
}

static uint8_t send_step(void)
{
    if (!i2c.address_next) {
        uint8_t reg = hal_host_sensor()->pointer;
        uint8_t before = hal_host_sensor()->reg[reg];
        bool is_value = hal_host_sensor()->pointer_written;
        bool ack = adxl345_model_write(hal_host_sensor(), i2c.data);
        if (is_value && reg != 0 && reg == hal_host_faults()->write_lost_register) {
            hal_host_sensor()->reg[reg] = before;
        }
        host_sensor_check_rate();
        return ack ? HAL_I2C_SENT_ACK : HAL_I2C_SENT_NACK;
    }
    i2c.address_next = false;
    i2c.reading = (i2c.data & 1u) != 0;
    bool ack = adxl345_model_start(hal_host_sensor(), i2c.data);
    if (i2c.reading) {
        return ack ? HAL_I2C_READ_ADDRESS_ACK : HAL_I2C_READ_ADDRESS_NACK;
    }
    return ack ? HAL_I2C_WRITE_ADDRESS_ACK : HAL_I2C_WRITE_ADDRESS_NACK;
}

static uint8_t command_step(command_t command)
{
    switch (command) {
    case COMMAND_START: {
        uint8_t status = i2c.in_transfer ? HAL_I2C_RESTARTED : HAL_I2C_STARTED;
        i2c.in_transfer = true;
        i2c.address_next = true;
        return status;
    }
    case COMMAND_SEND:
        return send_step();
    default: {
        uint8_t reg = hal_host_sensor()->pointer;
        bool identity = hal_host_faults()->id_wrong && reg == 0;
        uint8_t byte = adxl345_model_read(hal_host_sensor());
        if (host_config()->on_rx != NULL) {
            byte = host_config()->on_rx(reg, byte);
        }
        i2c.data = identity ? 0x00 : byte;
        return command == COMMAND_RECEIVE_ACK ? HAL_I2C_RECEIVED_ACK : HAL_I2C_RECEIVED_NACK;
    }
    }
}

void host_i2c_step(void)
{
    if (i2c.stop_at <= hal_host_now() && !hal_host_faults()->stop_stuck) {
        i2c.stop_at = HOST_NEVER;
        i2c.stop_pending = false;
        i2c.in_transfer = false;
        adxl345_model_stop(hal_host_sensor());
    }
    if (i2c.done_at > hal_host_now()) {
        return;
    }
    command_t command = i2c.command;
    i2c.command = COMMAND_NONE;
    i2c.done_at = HOST_NEVER;
    if (hal_host_faults()->next_status >= 0 && hal_host_faults()->status_skip-- == 0) {
        hal_host_faults()->status_skip = 0;
        i2c.status = (uint8_t)hal_host_faults()->next_status;
        hal_host_faults()->next_status = -1;
    } else {
        i2c.status = command_step(command);
    }
    hal_host_i2c_handler();
}
