/* When a fault is reported and shown. The texts are in reply_texts.h. */
#include "control/sensor_watch.h"

#include <stdbool.h>

#include "base/counters.h"
#include "base/notices.h"
#include "hal_led.h"
#include "machine.h"
#include "path/gravity.h"
#include "settings/settings.h"

/* Half a slot of the LED's pattern is 2^16 us; eight slots are about a second. */
#define FLASH_SHIFT 16
enum { FLASH_SLOTS = 8 };

#define MS_WRAP_S (UINT32_MAX / 1000u)

/* Flashes per second, by what to check: 1 the bus, 2 the sensor or its supply, 3 INT1, 4 the readings. */
static const uint8_t flashes[] IN_FLASH = {
    [ADXL345_FAULT_NO_SENSOR] = 2,     [ADXL345_FAULT_WRONG_ID] = 2,    [ADXL345_FAULT_BUS] = 1,
    [ADXL345_FAULT_READ_BACK] = 2,     [ADXL345_FAULT_INT1_SILENT] = 3, [ADXL345_FAULT_NO_DATA] = 2,
    [ADXL345_FAULT_SCL_LOW] = 1,       [ADXL345_FAULT_SDA_LOW] = 1,     [ADXL345_FAULT_INT1_STUCK] = 3,
    [ADXL345_FAULT_STUCK] = 4,         [ADXL345_FAULT_TORN] = 4,        [ADXL345_FAULT_TWO_SENSORS] = 4,
    [ADXL345_FAULT_INT1_FLICKERS] = 3, [FAULT_OTHER_PART] = 4,          [FAULT_I2C_SLOWED] = 1,
};

/* A fault that stands beside the outage and costs no sample: has had its first line, at: */
typedef struct {
    bool shown;
    uint32_t since_s;
} beside_t;

typedef struct {
    uint32_t began_us; /* start of the outage; the counters at that time: */
    uint32_t began_s;
    uint32_t began_lost;
    sensor_outage_t outage; /* numbers of the outage that is over, until the line with them is queued */
    uint16_t reported_mask; /* fault codes reported during the outage: each once */
    uint8_t newest;         /* its newest fault code; NONE: no outage */
    bool over;              /* the outage is over, and the line that reports it is not queued yet */
    beside_t part;          /* FAULT_OTHER_PART */
    beside_t slowed;        /* FAULT_I2C_SLOWED */
    uint8_t in_force;       /* one of these two, or none */
} watch_t;

static watch_t watch;
static sensor_outage_t reported;

const sensor_outage_t *sensor_watch_outage(void)
{
    return &reported;
}

static MACHINE_APART uint8_t with_beside(uint8_t fault)
{
    return fault != ADXL345_FAULT_NONE ? fault : watch.in_force;
}

uint8_t sensor_watch_fault(void)
{
    return with_beside((uint8_t)adxl345_fault());
}

/* Nothing is reported about the time before. */
static MACHINE_APART void forget(void)
{
    watch.newest = ADXL345_FAULT_NONE;
    watch.reported_mask = 0;
}

static void begin_outage(watch_t *w, uint32_t now_us)
{
    w->began_us = now_us;
    w->began_s = counted(COUNT_SECONDS);
    w->began_lost = counted(COUNT_LOST);
}

/* Milliseconds since then, in whole seconds. They wrap after 49 days. */
static MACHINE_APART uint32_t whole_ms(uint32_t began_s)
{
    uint32_t seconds = counted(COUNT_SECONDS) - began_s;
    return seconds < MS_WRAP_S ? seconds * 1000u : UINT32_MAX;
}

/* Microseconds wrap after 71 minutes: an outage of a minute or more is in whole seconds. */
static void end_outage(watch_t *w, uint32_t now_us)
{
    uint32_t ms = whole_ms(w->began_s);
    if (ms < 60000u) {
        ms = (now_us - w->began_us) / 1000u;
    }
    w->outage.ms = ms;
    w->outage.lost = counted(COUNT_LOST) - w->began_lost;
    w->outage.address = adxl345_address();
    w->over = true;
}

/*
 * Notes the state of the sensor, whether it can be reported or not. A fault that comes back before its end is reported
 * is the same outage. It is over when the pipeline has taken the samples that came again: the missing ones are counted
 * then.
 */
static void note(watch_t *w, uint8_t fault, uint32_t now_us)
{
    if (fault != ADXL345_FAULT_NONE) {
        if (w->newest == ADXL345_FAULT_NONE) {
            begin_outage(w, now_us);
        }
        w->newest = fault;
        w->over = false;
    } else if (!w->over && adxl345_phase() == ADXL345_STREAMING && adxl345_queued() == 0) {
        end_outage(w, now_us);
    }
}

/* The LED flashes for 65 ms in each of the first slots of 131 ms, eight of which make a second. */
static void show(uint8_t fault, uint32_t now_us)
{
    uint8_t half_slot = (uint8_t)(now_us >> FLASH_SHIFT);
    uint8_t slot = (half_slot >> 1) % FLASH_SLOTS;
    hal_led_set((half_slot & 1u) == 0 && slot < flash_u8(&flashes[fault]));
}

static MACHINE_APART uint16_t newest_bit(void)
{
    return (uint16_t)(1u << watch.newest);
}

uint8_t sensor_watch_start(uint32_t now_us)
{
    forget();
    watch.part.shown = false;
    watch.slowed.shown = false;
    note(&watch, (uint8_t)adxl345_fault(), now_us);
    watch.reported_mask = newest_bit();
    return watch.newest;
}

/* What is lost meanwhile is that of another fault. True: `reported` is in use. */
static MACHINE_APART bool tell_beside(beside_t *b, uint8_t fault, bool holds)
{
    bool shown = b->shown;
    if (shown == holds || !notices_add((notice_kind_t)(NOTICE_FAULT_BEGIN + shown), fault)) {
        return false;
    }
    b->shown = !shown;
    if (shown) {
        reported = (sensor_outage_t){ whole_ms(b->since_s), 0, adxl345_address() };
    } else {
        b->since_s = counted(COUNT_SECONDS);
    }
    return shown;
}

/* `reported` has room for one end. */
static MACHINE_APART bool may_tell(void)
{
    return settings()->mode != MODE_PLOT && !notices_hold(NOTICE_FAULT_END, NOTICE_FAULT_END);
}

void sensor_watch_second(void)
{
    watch_t *w = &watch;

    bool part = gravity_absent();
    bool slowed = adxl345_i2c_fell_back();
    uint8_t in_force = ADXL345_FAULT_NONE;
    if (slowed) {
        in_force = FAULT_I2C_SLOWED;
    }
    if (part) {
        in_force = FAULT_OTHER_PART;
    }
    w->in_force = in_force;
    /* without samples the driver may be trying one speed after the other */
    if (may_tell() && !tell_beside(&w->part, FAULT_OTHER_PART, part) && adxl345_phase() == ADXL345_STREAMING) {
        (void)tell_beside(&w->slowed, FAULT_I2C_SLOWED, slowed);
    }
}

/* Reports what was noted and is not reported yet. */
static void tell(watch_t *w)
{
    if (w->newest != ADXL345_FAULT_NONE && may_tell()) {
        uint16_t bit = newest_bit();
        if (!(w->reported_mask & bit)) {
            if (notices_add(NOTICE_FAULT_BEGIN, w->newest)) {
                w->reported_mask |= bit;
            }
        } else if (w->over && notices_add(NOTICE_FAULT_END, w->newest)) {
            reported = w->outage;
            forget();
        }
    }
}

void sensor_watch_pass(uint32_t now_us)
{
    watch_t *w = &watch;
    MACHINE_POINTER(w);
    uint8_t fault = (uint8_t)adxl345_fault();
    if (adxl345_phase() == ADXL345_STOPPED) { /* not repaired, just not polled */
        forget();
    }
    note(w, fault, now_us);
    show(with_beside(fault), now_us);
    tell(w);
}
