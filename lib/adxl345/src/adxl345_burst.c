/*
 * One burst per sample: INT_SOURCE, DATA_FORMAT, the data, FIFO_CTL, FIFO_STATUS. The data-ready handler starts it, the
 * I2C handler moves its bytes, main judges them (adxl345_integrity.h) and queues the sample; until main has done so no
 * other burst begins, and samples wait in the sensor's FIFO. INT_SOURCE comes before the data because it says of them
 * whether they are new and whether older ones were lost; behind them it no longer does (reading them clears both,
 * p. 21).
 *
 * When a burst fails before a data byte was asked for, the sample is still in the sensor and INT1 still high, so main
 * reads it again with the stamp of its edge. When it fails inside the data, that sample has left the FIFO (p. 21) and
 * its stamp goes with it: what main reads next is a later one.
 */
#include "adxl345_burst.h"

#include "adxl345_registers.h"
#include "adxl345_watch.h"
#include "hal_drdy.h"
#include "hal_irq.h"
#include "hal_sleep.h"
#include "hal_time.h"

enum { QUEUE_MASK = ADXL345_QUEUE_LENGTH - 1 };

#define SENSOR_DEPTH 33ul /* samples that the sensor can hold (p. 27) */

static i2c_bus_t bus;
static burst_entry_t queue[ADXL345_QUEUE_LENGTH];
static const int16_t *newest_lsb; /* of the last good one: taken or not, it is still there */
static volatile uint8_t head;
static volatile uint8_t tail;
static volatile uint8_t mode;
static volatile uint8_t on_bus; /* a burst that main has not judged: it runs, or has ended */
static volatile uint8_t edge_waiting;
static volatile uint32_t edge_us;
static volatile uint32_t begun_us; /* when the newest burst was put on the bus */
static uint8_t reading[READING_BYTES];
static uint32_t reading_us; /* stamp of the sample that is read */
static bool reading_exact;
static uint8_t failures;
static uint32_t last_us; /* stamp of the newest sample that left the sensor, delivered or cut */
static bool last_known;  /* last_us belongs to this run of the sensor */
static bool found_empty; /* the newest burst met no sample */
static uint8_t register_value;
static uint32_t period_us_q4;
static uint32_t taken_us;
static bool taken_exact;

HAL_IRQ_INLINE bool queue_has_room(void)
{
    return (uint8_t)((uint8_t)(head + 1u) & QUEUE_MASK) != tail;
}

HAL_IRQ_INLINE bool can_begin(void)
{
    return mode == BURST_READ && !on_bus && i2c_bus_free(&bus) && queue_has_room();
}

/* Interrupts off, or the bus made busy. */
HAL_IRQ_INLINE void begin_burst(uint32_t now_us, uint32_t t_us, bool exact)
{
    reading_us = t_us;
    reading_exact = exact;
    begun_us = now_us;
    on_bus = 1;
    bus.tx[0] = ADXL345_INT_SOURCE;
    bus.tx_length = 1;
    bus.rx_length = READING_BYTES;
    bus.rx = reading;
    i2c_bus_begin(&bus);
}

/* An edge whose level is gone again is noise: data-ready stays high until the data are read (p. 20). */
HAL_DRDY_ISR()
{
    if (!hal_drdy_high()) {
        return;
    }
    uint32_t now_us = hal_time_us_isr();
    if (can_begin()) {
        edge_waiting = 0;
        begin_burst(now_us, now_us, true);
        return;
    }
    edge_us = now_us;
    edge_waiting = 1;
    hal_wake();
}

HAL_I2C_ISR()
{
    i2c_bus_step(&bus);
    if (bus.state != I2C_BUS_BUSY) {
        hal_wake();
    }
}

void burst_init(void)
{
    hal_irq_state_t state = hal_irq_save();
    newest_lsb = queue[QUEUE_MASK].sample.lsb;
    head = 0;
    tail = 0;
    mode = BURST_IGNORE;
    on_bus = 0;
    failures = 0;
    edge_waiting = 0;
    last_known = false;
    bus.state = I2C_BUS_IDLE;
    hal_irq_restore(state);
}

void burst_set_mode(burst_mode_t new_mode)
{
    hal_irq_state_t state = hal_irq_save();
    if (mode == BURST_IGNORE) {
        edge_waiting = 0;
        failures = 0;
        last_known = false;
    }
    found_empty = found_empty && new_mode != BURST_READ;
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
    hal_irq_restore(state);
    (void)burst_judge();
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

/*
 * Stamp of a sample that was found waiting without an edge: one period after the one before it unless it is new, but
 * not before the sensor was last seen empty.
 */
static uint32_t waiting_since_us(uint32_t now_us, bool is_new)
{
    uint32_t period_us = burst_period_us();
    uint32_t t_us = last_us + period_us;
    if (found_empty && hal_time_reached(begun_us, t_us)) {
        t_us = begun_us;
    }
    bool plausible = !is_new && last_known && now_us - t_us <= SENSOR_DEPTH * period_us;
    return plausible ? t_us : now_us;
}

/* The bus is made busy first, so that no edge starts a burst and the rest needs no critical section. */
bool burst_read(bool is_new)
{
    hal_irq_state_t state = hal_irq_save();
    bool start = can_begin();
    bool exact = edge_waiting != 0;
    uint32_t t_us = edge_us;
    if (start) {
        bus.state = I2C_BUS_BUSY;
        edge_waiting = 0;
    }
    hal_irq_restore(state);
    if (start) {
        uint32_t now_us = hal_time_us();
        begin_burst(now_us, exact ? t_us : waiting_since_us(now_us, is_new), exact);
    }
    return start;
}

bool burst_drain(void)
{
    return hal_drdy_high() && burst_read(false);
}

/* One cut in its first data byte may have taken the sample or not: only an edge of its own gives a stamp then. */
static void keep_edge(void)
{
    if (failures != UINT8_MAX) {
        failures++;
    }
    if (reading_exact && !i2c_bus_asked(&bus, READING_DATA)) {
        edge_us = reading_us;
        edge_waiting = 1;
    }
}

/*
 * Where samples ahead of this one were lost its stamp is theirs, and one that is more than two periods too late for
 * the samples that wait behind it is that of INT1 coming back to a FIFO that had filled. The newest sample is half a
 * period old then.
 */
static void restamp(uint8_t behind, bool overrun)
{
    if (behind < 2u) {
        return;
    }
    uint32_t period_us = burst_period_us();
    uint32_t age_us = behind * period_us + (period_us >> 1);
    /* before the last one: a bit of the count was wrong */
    bool after_last = !last_known || !hal_time_reached(last_us, begun_us - age_us);
    if (after_last && (overrun || begun_us - reading_us + 2u * period_us < age_us)) {
        reading_us = begun_us - age_us;
        reading_exact = false;
    }
}

static reading_t judge(void)
{
    burst_entry_t *entry = &queue[head];
    reading_t verdict = integrity_judge(reading, entry->sample.lsb, newest_lsb);
    failures = 0;
    found_empty = verdict == READING_EMPTY;
    if (verdict == READING_GOOD) {
        restamp(reading[READING_FIFO_STATUS], (reading[READING_SOURCE] & ADXL345_INT_OVERRUN) != 0);
        newest_lsb = entry->sample.lsb;
        entry->sample.t_us = reading_us;
        entry->exact = reading_exact;
        entry->stuck = integrity_stuck();
        head = (uint8_t)((uint8_t)(head + 1u) & QUEUE_MASK);
    }
    return verdict;
}

/* No burst begins until on_bus is 0 again, so what the handlers wrote stays as it is. */
reading_t burst_judge(void)
{
    reading_t verdict = READING_NONE;
    if (!on_bus || bus.state == I2C_BUS_BUSY) {
        return verdict;
    }
    if (bus.state == I2C_BUS_OK) {
        verdict = judge();
    } else {
        keep_edge();
    }
    bool had_sample = i2c_bus_received(&bus, READING_DATA) && (reading[READING_SOURCE] & ADXL345_INT_DATA_READY);
    if (verdict == READING_GOOD || had_sample) {
        last_us = reading_us;
        last_known = true;
    }
    on_bus = 0;
    return verdict;
}

bool burst_running(void)
{
    return on_bus != 0;
}

bool burst_bus_taken(void)
{
    return on_bus != 0 || hal_i2c_stop_pending();
}

bool burst_found_empty(void)
{
    return found_empty;
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
    last_us = t_us;
}

uint32_t burst_met_sample_us(void)
{
    return found_empty ? last_us : burst_begun_us();
}

uint8_t burst_failures(void)
{
    return failures;
}

uint8_t burst_queued(void)
{
    return (uint8_t)((uint8_t)(head - tail) & QUEUE_MASK);
}

bool burst_queue_full(void)
{
    return !queue_has_room();
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

bool burst_oldest_us(uint32_t *t_us)
{
    uint8_t at = tail;
    if (at == head) {
        return false;
    }
    *t_us = queue[at].sample.t_us;
    return true;
}

bool burst_take(burst_entry_t *out)
{
    uint8_t at = tail;
    if (at == head) {
        return false;
    }
    *out = queue[at];
    tail = (uint8_t)((uint8_t)(at + 1u) & QUEUE_MASK);
    watch_sample(out->sample.lsb, queue[(uint8_t)(at - 1u) & QUEUE_MASK].sample.lsb);
    measure_period(out);
    return true;
}
