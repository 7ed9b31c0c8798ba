/*
 * One burst per sample: INT_SOURCE, DATA_FORMAT, the data, FIFO_CTL, FIFO_STATUS. The data-ready handler starts it, the
 * I2C handler moves its bytes, main judges them (adxl345_integrity.h) and queues the sample. Until main has done so no
 * other burst begins, and samples wait in the sensor's FIFO. INT_SOURCE comes before the data because it shows whether
 * they are new and whether older ones were lost; after the data it no longer does (reading them clears both, p. 21).
 *
 * If a burst fails before a data byte was requested, the sample is still in the sensor and INT1 still high, so main
 * reads it again with the stamp of its edge. If it fails within the data, that sample has left the FIFO (p. 21) and its
 * stamp is dropped with it: what main reads next is a later one.
 */
#include "adxl345_burst.h"

#include "adxl345_burst_state.h"
#include "adxl345_period.h"
#include "adxl345_registers.h"
#include "adxl345_watch.h"
#include "hal_drdy.h"
#include "hal_irq.h"
#include "hal_sleep.h"
#include "hal_time.h"
#include "machine.h"

enum { QUEUE_MASK = ADXL345_QUEUE_LENGTH - 1 };

#define ASKED_US 256u /* after a read begins: the sensor has been polled, and the next read is 0.3 ms away */

_Static_assert((int)READING_BYTES == (int)I2C_BUS_RX_MAX, "a reading fits");

static struct burst burst;

/* For functions of main with many accesses. The handlers use the fixed address, which needs no pointer register. */
static inline struct burst *base(void)
{
    struct burst *b = &burst;
    MACHINE_POINTER(b);
    return b;
}

/*
 * The queue entry for an index, of which only the lower bits count. The entry at head is free, because a burst begins
 * only if the queue has room: it takes the sample being read.
 */
static MACHINE_APART burst_entry_t *entry_at(uint8_t at)
{
    return &burst.queue[at & QUEUE_MASK];
}

MACHINE_INLINE bool queue_has_room(void)
{
    return (uint8_t)(burst.head - burst.tail) != QUEUE_MASK;
}

/* Interrupts off, or the bus already marked busy; begun_us is set by the caller. */
MACHINE_INLINE void begin_burst(struct burst *b, bool by_edge)
{
    b->by_edge = by_edge;
    b->on_bus = 1;
    i2c_bus_begin(&b->bus);
}

/* An edge whose level has already gone is noise: data-ready stays high until the data are read (p. 20). */
HAL_DRDY_ISR()
{
    uint16_t now = hal_time_count_isr();
    volatile uint32_t *stamp_us = &burst.edge_us;
    if (burst.mode == BURST_READ && !burst.on_bus && I2C_BUS_FREE(&burst.bus) && queue_has_room()) {
        burst.edge_waiting = 0;
        begin_burst(&burst, true);
        stamp_us = &burst.begun_us;
    } else {
        burst.edge_waiting = 1;
        hal_wake();
    }
    hal_time_stamp_isr(stamp_us, now);
}

HAL_I2C_ISR()
{
    i2c_bus_step(&burst.bus);
}

/*
 * Claims the bus for main and marks it busy: from then on no edge starts a burst. Interrupts are off for only this much
 * because the clock may have to wait for this, for the handler before it and for data-ready after it.
 */
static bool claim(struct burst *b)
{
    hal_irq_state_t state = hal_irq_save();
    if (b->on_bus || !I2C_BUS_FREE(&b->bus)) { /* keep the state of a burst that main has not judged */
        hal_irq_restore(state);
        return false;
    }
    b->bus.state = I2C_BUS_BUSY;
    hal_irq_restore(state);
    return true;
}

void adxl345_burst_init(void)
{
    struct burst *b = base();
    hal_irq_state_t state = hal_irq_save();
    b->head = 0;
    b->tail = 0;
    b->mode = BURST_IGNORE;
    b->on_bus = 0;
    b->edge_waiting = 0;
    b->bus.state = I2C_BUS_IDLE;
    hal_irq_restore(state);
}

void adxl345_burst_set_mode(burst_mode_t new_mode)
{
    struct burst *b = base();
    bool ignored = b->mode == BURST_IGNORE;
    if (ignored) {
        b->failures = 0;
        b->last_known = false;
    }
    if (new_mode == BURST_READ) { /* the transfer of every burst until main uses the bus again; none is running */
        b->verdict = READING_NONE;
        b->bus.tx[0] = ADXL345_INT_SOURCE;
        b->bus.tx_length = 1;
        b->bus.rx_length = READING_BYTES;
    }
    hal_irq_state_t state = hal_irq_save();
    if (ignored) {
        b->edge_waiting = 0;
    }
    b->mode = (uint8_t)new_mode;
    hal_irq_restore(state);
}

uint8_t adxl345_burst_take_bus(uint8_t address, uint8_t period_025us)
{
    struct burst *b = base();
    hal_irq_state_t state = hal_irq_save();
    hal_i2c_disable();
    uint8_t was = b->bus.state;
    b->bus.state = I2C_BUS_BUSY; /* no edge starts a burst while the bus is being cleared with interrupts on */
    b->bus.address = (uint8_t)(address * 2U);
    hal_irq_restore(state);
    uint8_t lines = hal_i2c_clear();
    hal_i2c_enable(period_025us);
    b->bus.state = was == I2C_BUS_BUSY ? (uint8_t)I2C_BUS_TIMEOUT : was; /* from here on an edge may start a burst */
    (void)adxl345_burst_judge();
    return lines;
}

bool adxl345_burst_access(uint8_t reg, uint8_t value, bool read)
{
    struct burst *b = base();
    bool free = claim(b);
    if (free) {
        b->bus.tx[0] = reg;
        b->bus.tx[1] = value;
        b->bus.tx_length = (uint8_t)(2u - read);
        b->bus.rx_length = read;
        i2c_bus_begin(&b->bus);
    }
    return free;
}

i2c_bus_state_t adxl345_burst_bus_state(void)
{
    return (i2c_bus_state_t)burst.bus.state;
}

uint8_t adxl345_burst_register_value(void)
{
    return burst.bus.rx[0];
}

bool adxl345_burst_register_holds(void)
{
    return burst.bus.rx[0] == burst.bus.tx[1];
}

/*
 * Stamp of a sample that was found waiting without an edge: one period after the previous one, but not in the future,
 * and not before the sensor was seen empty or, if it was not, longer ago than it can hold samples. That bound counts
 * when the reading of a full sensor is torn: its Overrun bit is lost, and its stamp is where the next one begins.
 */
static uint32_t waiting_since_us(const struct burst *b, uint32_t now_us)
{
    uint32_t step_us = adxl345_period_us();
    uint32_t t_us = b->last_us + step_us;
    uint32_t earliest_us = now_us - ADXL345_DEPTH * step_us;
    if (b->verdict == READING_EMPTY) {
        earliest_us = b->begun_us + ASKED_US;
    }
    if (hal_time_reached(earliest_us, t_us)) {
        t_us = earliest_us;
    }
    if (!b->last_known || hal_time_reached(t_us, now_us)) {
        t_us = now_us;
    }
    return t_us;
}

void adxl345_burst_read(void)
{
    struct burst *b = base();
    if (adxl345_burst_queue_full() || !claim(b)) {
        return;
    }
    burst_entry_t *entry = entry_at(b->head);
    uint32_t now_us = hal_time_us();
    entry->sample.t_us = waiting_since_us(b, now_us);
    entry->exact = false;
    b->int1 = hal_drdy_flickers() ? ADXL345_FAULT_INT1_FLICKERS : ADXL345_FAULT_INT1_SILENT;
    hal_irq_state_t state = hal_irq_save();
    uint8_t waiting = b->edge_waiting;
    uint32_t edge_us = b->edge_us;
    b->edge_waiting = 0;
    hal_irq_restore(state);
    if (hal_drdy_high()) { /* an edge whose level has gone belongs to no sample */
        b->int1 = ADXL345_FAULT_NONE;
        if (waiting) {
            entry->exact = true;
            entry->sample.t_us = edge_us;
        }
    }
    b->begun_us = now_us;
    begin_burst(b, false);
}

/* A burst that failed at its first data byte may or may not have taken the sample: then only an edge gives a stamp. */
static inline void keep_edge(struct burst *b, const burst_entry_t *entry, uint8_t asked)
{
    b->failed_state = b->bus.state;
    b->failures++;
    if (entry->exact && asked <= READING_DATA) {
        b->edge_us = entry->sample.t_us;
        b->edge_waiting = 1;
    }
}

/*
 * If samples before this one were lost, its stamp belongs to one of those. A stamp that is more than two periods too
 * late for the number of samples waiting after it is that of INT1 rising again at a FIFO that had filled up. The newest
 * sample is then half a period old.
 */
static MACHINE_APART void restamp(const struct burst *b, burst_entry_t *entry)
{
    uint32_t half_us = adxl345_period_us() >> 1;
    uint32_t t_us = b->begun_us - (uint8_t)(2u * b->bus.rx[READING_FIFO_STATUS] + 1u) * half_us;
    if (b->last_known && hal_time_reached(b->last_us, t_us)) {
        return; /* a bit of the count was wrong */
    }
    if ((b->bus.rx[READING_SOURCE] & ADXL345_INT_OVERRUN) ||
        !hal_time_reached(t_us + 4u * half_us, entry->sample.t_us)) {
        entry->sample.t_us = t_us;
        entry->exact = false;
    }
}

static reading_t judge(struct burst *b, burst_entry_t *entry)
{
    b->failures = 0;
    reading_t verdict = adxl345_integrity_judge(b->bus.rx, entry->sample.lsb,
                                                entry_at((uint8_t)(b->head - 1u))->sample.lsb);
    b->verdict = (uint8_t)verdict;
    if (verdict == READING_EMPTY && b->int1 == ADXL345_FAULT_NONE) {
        adxl345_integrity_int1_lied();
    }
    if (verdict != READING_GOOD) {
        return verdict;
    }
    if (b->edge_waiting) {
        b->int1 = ADXL345_FAULT_NONE; /* INT1 rose in the meantime */
    }
    if (b->bus.rx[READING_FIFO_STATUS] >= 2u) {
        restamp(b, entry);
    }
    entry->stuck = adxl345_integrity_stuck();
    b->head = (uint8_t)(b->head + 1u);
    return verdict;
}

/* No burst begins until on_bus is 0 again, so what the handlers wrote does not change. */
static MACHINE_APART reading_t judge_ended(void)
{
    struct burst *b = base();
    burst_entry_t *entry = entry_at(b->head);
    uint8_t asked = READING_BYTES;
    reading_t verdict = READING_FAILED;
    if (b->by_edge) {
        entry->sample.t_us = b->begun_us;
        entry->exact = true;
        b->int1 = ADXL345_FAULT_NONE;
    }
    if (b->bus.state == I2C_BUS_OK) {
        verdict = judge(b, entry);
    } else {
        asked = i2c_bus_asked(&b->bus);
        keep_edge(b, entry, asked);
    }
    if (verdict == READING_GOOD ||
        (asked > READING_DATA + 1u && (b->bus.rx[READING_SOURCE] & ADXL345_INT_DATA_READY))) {
        b->last_us = entry->sample.t_us;
        b->last_known = true;
    }
    b->on_bus = 0;
    return verdict;
}

/* Called in every pass, most of which find nothing. */
reading_t adxl345_burst_judge(void)
{
    return !burst.on_bus || burst.bus.state == I2C_BUS_BUSY ? READING_NONE : judge_ended();
}

bool adxl345_burst_running(void)
{
    return burst.on_bus != 0;
}

bool adxl345_sample_waits(void)
{
    return hal_drdy_high() && burst.mode == BURST_READ && (burst.verdict != READING_EMPTY || burst.edge_waiting);
}

uint8_t adxl345_burst_int1(void)
{
    return burst.int1;
}

MACHINE_APART uint32_t adxl345_burst_begun_us(void)
{
    hal_irq_state_t state = hal_irq_save();
    uint32_t t_us = burst.begun_us;
    hal_irq_restore(state);
    return t_us;
}

void adxl345_burst_expect(uint32_t t_us)
{
    struct burst *b = base();
    b->begun_us = t_us;
    b->last_us = t_us;
}

uint32_t adxl345_burst_last_us(void)
{
    return burst.last_us;
}

i2c_bus_state_t adxl345_burst_failed_state(void)
{
    return (i2c_bus_state_t)burst.failed_state;
}

uint8_t adxl345_burst_failures(void)
{
    return burst.failures;
}

uint8_t adxl345_queued(void)
{
    return (uint8_t)(burst.head - burst.tail);
}

bool adxl345_burst_queue_full(void)
{
    return adxl345_queued() == QUEUE_MASK;
}

bool adxl345_oldest_us(uint32_t *t_us)
{
    uint8_t at = burst.tail;
    if (at == burst.head) {
        return false;
    }
    *t_us = entry_at(at)->sample.t_us;
    return true;
}

const burst_entry_t *adxl345_burst_take(void)
{
    struct burst *b = base();
    uint8_t at = b->tail;
    const burst_entry_t *entry = entry_at(at);
    const burst_entry_t *before = entry_at((uint8_t)(at - 1u));
    b->tail = (uint8_t)(at + 1u);
    adxl345_watch_sample(entry->sample.lsb, before->sample.lsb);
    adxl345_period_sample(entry->sample.t_us, entry->exact);
    return entry;
}
