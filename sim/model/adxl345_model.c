/*
 * Page numbers are those of the ADXL345 data sheet, Rev. E. Tap, activity and free-fall detection are not computed:
 * their INT_SOURCE bits rise only through adxl345_model_event.
 */
#include "adxl345_model.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "adxl345_registers.h"

enum {
    ACT_TAP_STATUS = 0x2B,
    TAP_AXES = 0x2A,
    DATA_LAST = ADXL345_DATAX0 + 5,
    REGISTER_MASK = 0x3F,
    MEASURE_BITS = ADXL345_POWER_MEASURE | 0x04, /* Measure and Sleep */
    BIT_INVERT = 0x20,
    BIT_JUSTIFY = 0x04,
    BIT_TRIGGER_ON_INT2 = 0x20,
    BIT_FIFO_TRIG = 0x80,
    SAMPLES_MASK = 0x1F,
    FIFO_FILLED = 32,   /* p. 21: "until it is full (32 samples)" */
    EVENTS_MASK = 0x7C, /* taps, activity, inactivity, free fall: cleared by reading INT_SOURCE (p. 26) */
    SETTLED = 5,        /* samples until the force has settled */
    OFFSET_LSB = 4,     /* 15.6 mg / 3.9 mg (p. 24) */
    RATE_CODE_1600 = 0x0E
};

enum fifo_mode { MODE_BYPASS = 0, MODE_FIFO = 1, MODE_STREAM = 2, MODE_TRIGGER = 3 };

/* The self-test shift is that of the ADXL345 (adxl345_variants.c). */
const adxl345_part_t adxl345_part_typical = { { 1.0, 1.0, 1.0 }, { 0, 0, 0 }, { 522, -522, 698 } };

static unsigned fifo_mode(const adxl345_model_t *m)
{
    return m->reg[ADXL345_FIFO_CTL] >> 6;
}

static bool measuring(const adxl345_model_t *m)
{
    return m->powered && (m->reg[ADXL345_POWER_CTL] & MEASURE_BITS) == ADXL345_POWER_MEASURE;
}

static void drop_oldest(adxl345_model_t *m, uint8_t keep)
{
    uint8_t dropped = (uint8_t)(m->fifo_count - keep);
    memmove(m->fifo[0], m->fifo[dropped], keep * sizeof m->fifo[0]);
    m->fifo_count = keep;
}

static bool watermark(const adxl345_model_t *m)
{
    uint8_t samples = m->reg[ADXL345_FIFO_CTL] & SAMPLES_MASK;
    return samples == 0 || (fifo_mode(m) != MODE_BYPASS && m->fifo_count >= samples);
}

static uint8_t interrupt_source(const adxl345_model_t *m)
{
    unsigned source = m->events;
    if (fifo_mode(m) == MODE_BYPASS ? m->data_ready : m->fifo_count != 0) {
        source |= ADXL345_INT_DATA_READY;
    }
    if (watermark(m)) {
        source |= ADXL345_INT_WATERMARK;
    }
    if (m->overrun) {
        source |= ADXL345_INT_OVERRUN;
    }
    return (uint8_t)source;
}

static void set_pin(adxl345_model_t *m, unsigned pin, bool high)
{
    if (m->pin_high[pin] == high) {
        return;
    }
    m->pin_high[pin] = high;
    if (m->pin_changed != NULL) {
        m->pin_changed(m->owner, pin, high);
    }
}

/* Trigger mode keeps the last n samples before the event, then collects like FIFO mode (p. 21). */
static void trigger(adxl345_model_t *m)
{
    uint8_t samples = m->reg[ADXL345_FIFO_CTL] & SAMPLES_MASK;
    m->triggered = true;
    if (m->fifo_count > samples) {
        drop_oldest(m, samples);
    }
}

/* Call after every change of state: updates INT_SOURCE, FIFO_STATUS, trigger, both pins. */
static void refresh(adxl345_model_t *m)
{
    uint8_t enabled = interrupt_source(m) & m->reg[ADXL345_INT_ENABLE];
    uint8_t map = m->reg[ADXL345_INT_MAP];
    bool active1 = (enabled & (uint8_t)~map) != 0;
    bool active2 = (enabled & map) != 0;
    bool event = (m->reg[ADXL345_FIFO_CTL] & BIT_TRIGGER_ON_INT2) ? active2 : active1;
    if (fifo_mode(m) == MODE_TRIGGER && event && !m->triggered) {
        trigger(m);
    }
    m->reg[ADXL345_INT_SOURCE] = interrupt_source(m);
    m->reg[ADXL345_FIFO_STATUS] = (uint8_t)(m->fifo_count | (m->triggered ? BIT_FIFO_TRIG : 0));
    for (size_t axis = 0; axis < 3; axis++) {
        uint16_t word = (uint16_t)m->fifo[0][axis];
        m->reg[ADXL345_DATAX0 + 2 * axis] = (uint8_t)word;
        m->reg[ADXL345_DATAX0 + 2 * axis + 1] = (uint8_t)(word >> 8);
    }
    bool invert = (m->reg[ADXL345_DATA_FORMAT] & BIT_INVERT) != 0;
    set_pin(m, 1, m->powered && active1 != invert);
    set_pin(m, 2, m->powered && active2 != invert);
}

static void forget_data(adxl345_model_t *m)
{
    m->fifo_count = 0;
    m->data_ready = false;
    m->overrun = false;
    m->triggered = false;
    m->has_pending = false;
}

static void registers_at_reset(adxl345_model_t *m)
{
    memset(m->reg, 0, sizeof m->reg);
    memset(m->fifo, 0, sizeof m->fifo);
    m->reg[ADXL345_DEVID] = m->device_id;
    m->reg[ADXL345_BW_RATE] = ADXL345_BW_RATE_RESET;
    m->pointer = 0;
    m->events = 0;
    m->selected = false;
    m->reading = false;
    m->pointer_written = false;
    m->data_touched = false;
    m->ticks_in_measure = 0;
    forget_data(m);
}

void adxl345_model_init(adxl345_model_t *m)
{
    memset(m, 0, sizeof *m);
    m->address = ADXL345_ADDRESS_LOW;
    m->device_id = adxl345_itself->device_id;
    m->variant = adxl345_itself;
    m->shadowing = true;
    m->part = adxl345_part_typical;
    m->powered = true;
    registers_at_reset(m);
    refresh(m);
}

void adxl345_model_become(adxl345_model_t *m, const adxl345_variant_t *variant)
{
    m->variant = variant;
    m->device_id = variant->device_id;
    memcpy(m->part.self_test_lsb, variant->self_test_lsb, sizeof m->part.self_test_lsb);
    adxl345_model_power(m, true);
}

void adxl345_model_power(adxl345_model_t *m, bool on)
{
    m->powered = on;
    registers_at_reset(m);
    refresh(m);
}

void adxl345_model_event(adxl345_model_t *m, uint8_t source_bits)
{
    if (m->powered) {
        m->events = (uint8_t)(m->events | (source_bits & EVENTS_MASK));
        refresh(m);
    }
}

static void store_latest(adxl345_model_t *m, const int16_t lsb[3])
{
    if (m->data_ready) {
        m->overrun = true;
        m->overruns++;
    }
    memcpy(m->fifo[0], lsb, sizeof m->fifo[0]);
    m->data_ready = true;
}

/* False if the sample is lost because the FIFO is full. */
static bool store_queued(adxl345_model_t *m, const int16_t lsb[3])
{
    bool keeps_newest = fifo_mode(m) == MODE_STREAM || (fifo_mode(m) == MODE_TRIGGER && !m->triggered);
    if (m->fifo_count == ADXL345_MODEL_FIFO_DEPTH) {
        m->overruns++;
        if (!keeps_newest) {
            return false;
        }
        drop_oldest(m, ADXL345_MODEL_FIFO_DEPTH - 1);
    }
    memcpy(m->fifo[m->fifo_count], lsb, sizeof m->fifo[0]);
    m->fifo_count++;
    if (m->fifo_count >= FIFO_FILLED) {
        m->overrun = true;
    }
    return true;
}

static void store(adxl345_model_t *m, const int16_t lsb[3])
{
    int16_t kept[3];
    memcpy(kept, lsb, sizeof kept);
    bool readable = true;
    if (fifo_mode(m) == MODE_BYPASS) {
        store_latest(m, kept);
    } else {
        readable = store_queued(m, kept);
    }
    if (readable && m->latched != NULL) {
        m->latched(m->owner, kept);
    }
    refresh(m);
}

/* "The transition from Register 0x37 to Register 0x38" or the end of the transfer ends a read of the data (p. 21). */
static void end_data_read(adxl345_model_t *m)
{
    if (!m->data_touched) {
        return;
    }
    m->data_touched = false;
    m->data_reads++;
    if (fifo_mode(m) != MODE_BYPASS && m->fifo_count != 0) {
        drop_oldest(m, (uint8_t)(m->fifo_count - 1));
        m->overrun = false;
    }
    refresh(m);
    if (m->has_pending) {
        m->has_pending = false;
        store(m, m->pending);
    }
}

bool adxl345_model_start(adxl345_model_t *m, uint8_t address_byte)
{
    end_data_read(m);
    m->selected = m->powered && (address_byte >> 1) == m->address;
    m->reading = (address_byte & 1u) != 0;
    m->pointer_written = false;
    return m->selected;
}

void adxl345_model_stop(adxl345_model_t *m)
{
    end_data_read(m);
    m->selected = false;
}

/* Bits that a register keeps; 0 for read-only and reserved registers (p. 23-27). */
static uint8_t writable_bits(uint8_t address)
{
    switch (address) {
    case TAP_AXES:
        return 0x0F;
    case ADXL345_BW_RATE:
        return 0x1F;
    case ADXL345_POWER_CTL:
        return 0x3F;
    case ADXL345_DATA_FORMAT:
        return 0xEF;
    case ACT_TAP_STATUS:
    case ADXL345_INT_SOURCE:
        return 0;
    case ADXL345_FIFO_CTL:
        return 0xFF;
    default:
        return address >= ADXL345_THRESH_TAP && address < ADXL345_DATAX0 ? 0xFF : 0;
    }
}

static void write_register(adxl345_model_t *m, uint8_t address, uint8_t value)
{
    uint8_t mask = writable_bits(address);
    if (mask == 0) {
        return;
    }
    bool was_measuring = measuring(m);
    unsigned mode_before = fifo_mode(m);
    if (was_measuring && address != ADXL345_POWER_CTL) {
        m->writes_while_measuring++;
    }
    m->reg[address] = value & mask;
    if (measuring(m) && !was_measuring) {
        m->ticks_in_measure = 0;
    }
    bool bypass_left_or_entered = (mode_before == MODE_BYPASS) != (fifo_mode(m) == MODE_BYPASS);
    if (address == ADXL345_FIFO_CTL && bypass_left_or_entered) {
        forget_data(m);
    }
    refresh(m);
}

bool adxl345_model_write(adxl345_model_t *m, uint8_t byte)
{
    if (!m->selected || m->reading) {
        return false;
    }
    if (!m->pointer_written) {
        m->pointer = byte & REGISTER_MASK;
        m->pointer_written = true;
        return true;
    }
    uint8_t address = m->pointer;
    m->pointer = (address + 1u) & REGISTER_MASK;
    write_register(m, address, byte);
    return true;
}

static void touch_data(adxl345_model_t *m)
{
    m->data_touched = true;
    if (fifo_mode(m) == MODE_BYPASS && (m->data_ready || m->overrun)) {
        m->data_ready = false;
        m->overrun = false;
        refresh(m);
    }
}

uint8_t adxl345_model_read(adxl345_model_t *m)
{
    if (!m->selected || !m->reading) {
        return 0xFF;
    }
    uint8_t address = m->pointer;
    uint8_t value = m->reg[address];
    m->pointer = (address + 1u) & REGISTER_MASK;
    if (address >= ADXL345_DATAX0 && address <= DATA_LAST) {
        touch_data(m);
        if (address == DATA_LAST) {
            end_data_read(m);
        }
    } else if (address == ADXL345_INT_SOURCE && m->events != 0) {
        m->events = 0;
        refresh(m);
    }
    return value;
}

double adxl345_model_odr_hz(const adxl345_model_t *m)
{
    if (!measuring(m)) {
        return 0.0;
    }
    unsigned code = m->reg[ADXL345_BW_RATE] & ADXL345_BW_RATE_MASK;
    return 3200.0 / (double)(1u << (15u - code));
}

static unsigned range_code(const adxl345_model_t *m)
{
    unsigned code = m->reg[ADXL345_DATA_FORMAT] & ADXL345_FORMAT_RANGE_MASK;
    return m->variant->one_range ? ADXL345_FORMAT_RANGE_MASK : code;
}

double adxl345_model_range_g(const adxl345_model_t *m)
{
    return m->variant->range_g / (double)(1u << (ADXL345_FORMAT_RANGE_MASK - range_code(m)));
}

static int32_t divide_down(int32_t value, int32_t divisor)
{
    int32_t quotient = value / divisor;
    return value % divisor < 0 ? quotient - 1 : quotient;
}

static int32_t clamp(int32_t value, int32_t low, int32_t high)
{
    if (value < low) {
        return low;
    }
    return value > high ? high : value;
}

/*
 * The reading of an acceleration by this part, in full resolution before its offset registers; rounded half up. The
 * self-test force settles over four samples (p. 22).
 */
static int32_t sense(const adxl345_model_t *m, size_t axis, int16_t full)
{
    double scale = m->part.gain[axis] * (m->variant->lsb_per_g / adxl345_itself->lsb_per_g);
    int32_t value = (int32_t)floor(full * scale + 0.5) + m->part.offset_lsb[axis];
    if ((m->reg[ADXL345_DATA_FORMAT] & ADXL345_FORMAT_SELF_TEST) != 0) {
        int32_t samples = m->ticks_in_measure < SETTLED ? (int32_t)m->ticks_in_measure : SETTLED;
        value += m->part.self_test_lsb[axis] * samples / SETTLED;
    }
    return value;
}

void adxl345_model_convert(const adxl345_model_t *m, const int16_t full[3], int16_t lsb[3])
{
    uint8_t format = m->reg[ADXL345_DATA_FORMAT];
    unsigned range = range_code(m);
    bool full_res = m->variant->one_range || (format & ADXL345_FORMAT_FULL_RES) != 0;
    int32_t divisor = full_res ? 1 : (int32_t)(1u << range);
    int32_t rail = full_res ? (int32_t)(512u << range) : 512;
    bool coarse = (m->reg[ADXL345_BW_RATE] & ADXL345_BW_RATE_MASK) >= RATE_CODE_1600 && (full_res || range == 0);
    /* left justified: the sign bit is bit 15 (p. 27); 10 bits, and one more per range step in full resolution */
    int32_t justify = (format & BIT_JUSTIFY) ? 32768 / rail : 1;
    for (size_t axis = 0; axis < 3; axis++) {
        int32_t value = sense(m, axis, full[axis]);
        value += (int32_t)(int8_t)m->reg[ADXL345_OFSX + axis] * OFFSET_LSB;
        value = clamp(divide_down(value, divisor), -rail, rail - 1);
        if (coarse) {
            value = divide_down(value, 2) * 2; /* the LSB is always 0 at 1600 and 3200 Hz (p. 32) */
        }
        lsb[axis] = (int16_t)(value * justify);
    }
}

bool adxl345_model_tick(adxl345_model_t *m, const int16_t full[3])
{
    if (!measuring(m)) {
        return false;
    }
    m->samples++;
    m->ticks_in_measure++;
    int16_t lsb[3];
    adxl345_model_convert(m, full, lsb);
    bool would_change_shown = fifo_mode(m) == MODE_BYPASS || m->fifo_count == 0 ||
                              m->fifo_count == ADXL345_MODEL_FIFO_DEPTH;
    if (m->data_touched && would_change_shown && m->shadowing) {
        if (m->has_pending) {
            m->overrun = true;
            m->overruns++;
        }
        memcpy(m->pending, lsb, sizeof m->pending);
        m->has_pending = true;
        return true;
    }
    if (m->data_touched && would_change_shown) {
        m->torn++;
    }
    store(m, lsb);
    return true;
}
