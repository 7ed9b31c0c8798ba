/*
 * One burst of six bytes per sample, straight into a slot of the queue. The data-ready handler starts it, the I2C
 * handler moves its bytes. When it fails before a data byte was asked for, the sample is still in the sensor and INT1
 * still high, so main reads it again with the stamp of its edge. When it fails inside the data, that sample has left
 * the FIFO (p. 21) and its stamp goes with it: what main reads next is a later one.
 */
#include "adxl345_burst.h"

#include "adxl345_registers.h"
#include "hal_drdy.h"
#include "hal_irq.h"
#include "hal_sleep.h"
#include "hal_time.h"

enum { SAMPLE_BYTES = 6, QUEUE_MASK = ADXL345_QUEUE_LENGTH - 1 };

#define SENSOR_DEPTH 33ul /* samples that the sensor can hold (p. 27) */

typedef struct {
    uint32_t t_us;
    uint8_t raw[SAMPLE_BYTES];
    uint8_t exact;
} slot_t;

static i2c_bus_t bus;
static slot_t queue[ADXL345_QUEUE_LENGTH];
static volatile uint8_t head; /* I2C handler */
static volatile uint8_t tail; /* main */
static volatile uint8_t mode;
static volatile uint8_t on_bus; /* the transfer is a burst */
static volatile uint8_t failures;
static volatile uint8_t edge_waiting;
static volatile uint32_t edge_us;
static volatile uint32_t begun_us;  /* when the newest burst was put on the bus */
static volatile uint32_t last_us;   /* stamp of the newest sample that left the sensor, delivered or cut */
static volatile uint8_t last_known; /* last_us belongs to this run of the sensor */
static uint8_t register_value;
static uint32_t period_us_q4;
static uint32_t taken_us;
static bool taken_exact;

static inline bool queue_has_room(void)
{
    return (uint8_t)((uint8_t)(head + 1u) & QUEUE_MASK) != tail;
}

/* Interrupts off. */
static inline void begin_burst(uint32_t now_us, uint32_t t_us, uint8_t exact)
{
    slot_t *slot = &queue[head];
    slot->t_us = t_us;
    slot->exact = exact;
    begun_us = now_us;
    edge_waiting = 0;
    on_bus = 1;
    bus.tx[0] = ADXL345_DATAX0;
    bus.tx_length = 1;
    bus.rx_length = SAMPLE_BYTES;
    bus.rx = slot->raw;
    i2c_bus_begin(&bus);
}

HAL_DRDY_ISR()
{
    uint32_t now_us = hal_time_us_isr();
    if (mode == BURST_IGNORE) {
        return;
    }
    if (mode == BURST_READ && i2c_bus_free(&bus) && queue_has_room()) {
        begin_burst(now_us, now_us, 1);
        return;
    }
    edge_us = now_us;
    edge_waiting = 1;
    hal_wake();
}

/* A burst cut in its first data byte may have taken the sample or not: only an edge of its own gives a stamp then. */
static inline void end_burst(void)
{
    on_bus = 0;
    if (i2c_bus_received(&bus)) {
        last_us = queue[head].t_us;
        last_known = 1;
    }
    if (bus.state == I2C_BUS_OK) {
        head = (uint8_t)((uint8_t)(head + 1u) & QUEUE_MASK);
        failures = 0;
        return;
    }
    if (failures != UINT8_MAX) {
        failures++;
    }
    if (queue[head].exact && !i2c_bus_asked(&bus)) {
        edge_us = queue[head].t_us;
        edge_waiting = 1;
    }
}

HAL_I2C_ISR()
{
    i2c_bus_step(&bus);
    if (bus.state == I2C_BUS_BUSY) {
        return;
    }
    if (on_bus) {
        end_burst();
    }
    hal_wake();
}

void burst_init(void)
{
    hal_irq_state_t state = hal_irq_save();
    head = 0;
    tail = 0;
    mode = BURST_IGNORE;
    on_bus = 0;
    failures = 0;
    edge_waiting = 0;
    last_known = 0;
    bus.state = I2C_BUS_IDLE;
    hal_irq_restore(state);
}

void burst_set_mode(burst_mode_t new_mode)
{
    hal_irq_state_t state = hal_irq_save();
    if (mode == BURST_IGNORE) {
        edge_waiting = 0;
        failures = 0;
        last_known = 0;
    }
    mode = (uint8_t)new_mode;
    hal_irq_restore(state);
}

uint8_t burst_take_bus(uint8_t address, bool fast)
{
    hal_irq_state_t state = hal_irq_save();
    hal_i2c_disable();
    bool was_busy = bus.state == I2C_BUS_BUSY;
    bus.state = I2C_BUS_BUSY; /* so that no edge starts a burst while the bus is being cleared, with interrupts on */
    hal_irq_restore(state);
    uint8_t lines = hal_i2c_clear();
    state = hal_irq_save();
    hal_i2c_enable(fast);
    bus.state = was_busy ? I2C_BUS_TIMEOUT : I2C_BUS_IDLE;
    bus.address = (uint8_t)(address * 2U);
    if (on_bus) {
        end_burst();
    }
    hal_irq_restore(state);
    return lines;
}

static bool begin_register(uint8_t reg, uint8_t value, uint8_t tx_length, uint8_t rx_length)
{
    hal_irq_state_t state = hal_irq_save();
    bool free = i2c_bus_free(&bus);
    if (free) {
        bus.tx[0] = reg;
        bus.tx[1] = value;
        bus.tx_length = tx_length;
        bus.rx_length = rx_length;
        bus.rx = &register_value;
        i2c_bus_begin(&bus);
    }
    hal_irq_restore(state);
    return free;
}

bool burst_write_register(uint8_t reg, uint8_t value)
{
    return begin_register(reg, value, 2, 0);
}

bool burst_read_register(uint8_t reg)
{
    return begin_register(reg, 0, 1, 1);
}

i2c_bus_state_t burst_bus_state(void)
{
    return (i2c_bus_state_t)bus.state;
}

uint8_t burst_register_value(void)
{
    return register_value;
}

/* Stamp of a sample that was found waiting: its own edge, else one period after the one before it unless it is new. */
static uint32_t waiting_since_us(uint32_t now_us, bool is_new)
{
    uint32_t period_us = burst_period_us();
    if (edge_waiting) {
        return edge_us;
    }
    uint32_t age_us = now_us - (last_us + period_us);
    bool plausible = !is_new && last_known && age_us <= SENSOR_DEPTH * period_us;
    return plausible ? now_us - age_us : now_us;
}

bool burst_read(bool is_new)
{
    hal_irq_state_t state = hal_irq_save();
    bool start = mode == BURST_READ && i2c_bus_free(&bus) && queue_has_room();
    if (start) {
        uint32_t now_us = hal_time_us_isr();
        begin_burst(now_us, waiting_since_us(now_us, is_new), edge_waiting);
    }
    hal_irq_restore(state);
    return start;
}

bool burst_drain(void)
{
    return hal_drdy_high() && burst_read(false);
}

bool burst_running(void)
{
    return on_bus != 0;
}

bool burst_bus_taken(void)
{
    return on_bus != 0 || hal_i2c_stop_pending();
}

uint32_t burst_begun_us(void)
{
    hal_irq_state_t state = hal_irq_save();
    uint32_t t_us = begun_us;
    hal_irq_restore(state);
    return t_us;
}

void burst_expect(uint32_t t_us)
{
    hal_irq_state_t state = hal_irq_save();
    begun_us = t_us;
    hal_irq_restore(state);
}

uint8_t burst_failures(void)
{
    return failures;
}

uint8_t burst_successes(void)
{
    return head;
}

uint8_t burst_queued(void)
{
    return (uint8_t)((uint8_t)(head - tail) & QUEUE_MASK);
}

bool burst_queue_full(void)
{
    return !queue_has_room();
}

static inline int16_t axis(const uint8_t *raw)
{
    return (int16_t)(uint16_t)(raw[0] | (uint16_t)((uint16_t)raw[1] << 8));
}

void burst_set_period(uint32_t nominal_us)
{
    period_us_q4 = nominal_us * 16u;
    taken_exact = false;
}

uint32_t burst_period_us(void)
{
    return period_us_q4 >> 4;
}

/* Follows the true period (a sixteenth of each difference) where two stamps in a row are exact and near it. */
static void measure_period(const burst_entry_t *entry)
{
    uint32_t period_us = burst_period_us();
    uint32_t error_us = entry->sample.t_us - taken_us - period_us;
    uint32_t eighth_us = period_us >> 3;
    if (entry->exact && taken_exact && error_us + eighth_us <= eighth_us + eighth_us) {
        period_us_q4 += error_us;
    }
    taken_us = entry->sample.t_us;
    taken_exact = entry->exact;
}

bool burst_take(burst_entry_t *out)
{
    uint8_t at = tail;
    if (at == head) {
        return false;
    }
    const slot_t *slot = &queue[at];
    out->sample.t_us = slot->t_us;
    out->exact = slot->exact != 0;
    for (uint8_t i = 0; i < 3; i++) {
        out->sample.lsb[i] = axis(&slot->raw[2u * i]);
    }
    tail = (uint8_t)((uint8_t)(at + 1u) & QUEUE_MASK);
    measure_period(out);
    return true;
}
