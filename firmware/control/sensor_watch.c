/* When a fault is reported and shown. The texts are in reply_texts.h. */
#include "control/sensor_watch.h"

#include <stdbool.h>

#include "adxl345.h"
#include "base/counters.h"
#include "base/notices.h"
#include "hal_led.h"
#include "machine.h"
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
    [ADXL345_FAULT_INT1_FLICKERS] = 3,
};

typedef struct {
    uint32_t began_us; /* start of the outage; the counters at that time: */
    uint32_t began_s;
    uint32_t began_lost;
    sensor_outage_t outage; /* numbers of the outage that is over, until the line with them is queued */
    uint16_t reported_mask; /* fault codes reported during the outage: each once */
    uint8_t newest;         /* its newest fault code; NONE: no outage */
    bool over;              /* the outage is over, and the line that reports it is not queued yet */
} watch_t;

static watch_t watch;
static sensor_outage_t reported;

const sensor_outage_t *sensor_watch_outage(void)
{
    return &reported;
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

/* Microseconds wrap after 71 minutes: an outage of a minute or more is in whole seconds. Milliseconds wrap too. */
static void end_outage(watch_t *w, uint32_t now_us)
{
    uint32_t seconds = counted(COUNT_SECONDS) - w->began_s;
    if (seconds < 60u) {
        w->outage.ms = (now_us - w->began_us) / 1000u;
    } else {
        w->outage.ms = seconds < MS_WRAP_S ? seconds * 1000u : UINT32_MAX;
    }
    w->outage.lost = counted(COUNT_LOST) - w->began_lost;
    w->outage.address = adxl345_address();
    w->over = true;
}

/*
 * Notes the state of the sensor, whether it can be reported or not. A fault that comes back before its end is reported
 * is the same outage. It is over when the pipeline has taken the samples that came again: the missing ones are counted
 * then.
 */
static void note(uint8_t fault, uint32_t now_us)
{
    watch_t *w = &watch;
    MACHINE_POINTER(w);
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

void sensor_watch_start(uint32_t now_us)
{
    forget();
    note((uint8_t)adxl345_fault(), now_us);
    watch.reported_mask = (uint16_t)(1u << watch.newest);
}

/* Reports what was noted and is not reported yet, one line at a time. */
static void tell(void)
{
    uint16_t bit = (uint16_t)(1u << watch.newest);
    if (watch.newest == ADXL345_FAULT_NONE || settings()->mode == MODE_PLOT) {
        return;
    }
    if (!(watch.reported_mask & bit)) {
        if (notices_add(NOTICE_FAULT_BEGIN, watch.newest)) {
            watch.reported_mask |= bit;
        }
    } else if (watch.over && !notices_hold(NOTICE_FAULT_END, NOTICE_FAULT_END) &&
               notices_add(NOTICE_FAULT_END, watch.newest)) {
        reported = watch.outage;
        forget();
    }
}

void sensor_watch_pass(uint32_t now_us)
{
    uint8_t fault = (uint8_t)adxl345_fault();
    show(fault, now_us);
    if (adxl345_phase() == ADXL345_STOPPED) {
        forget(); /* not repaired, just not polled */
    }
    note(fault, now_us);
    tell();
}
