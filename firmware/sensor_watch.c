/* When a fault is told and shown. The words are in reply_texts.h. */
#include "sensor_watch.h"

#include <stdbool.h>

#include "adxl345.h"
#include "counters.h"
#include "flash.h"
#include "hal_led.h"
#include "replies.h"
#include "settings.h"

/* A second is eight times this, as good as: what of the time of now goes into the pattern of the LED. */
#define FLASH_SHIFT 16
enum { FLASH_SLOTS = 8 };

#define MS_WRAP_S (UINT32_MAX / 1000u)

/* Flashes in a second, by what to look at: 1 the bus, 2 the sensor or its supply, 3 INT1, 4 the readings. */
static const uint8_t flashes[] FLASH = {
    [ADXL345_FAULT_NO_SENSOR] = 2, [ADXL345_FAULT_WRONG_ID] = 2,    [ADXL345_FAULT_BUS] = 1,
    [ADXL345_FAULT_READ_BACK] = 2, [ADXL345_FAULT_INT1_SILENT] = 3, [ADXL345_FAULT_NO_DATA] = 2,
    [ADXL345_FAULT_SCL_LOW] = 1,   [ADXL345_FAULT_SDA_LOW] = 1,     [ADXL345_FAULT_INT1_STUCK] = 3,
    [ADXL345_FAULT_STUCK] = 4,     [ADXL345_FAULT_TORN] = 4,        [ADXL345_FAULT_TWO_SENSORS] = 4,
};

sensor_outage_t sensor_watch_outage;

static uint8_t told;       /* fault code of the last line, NONE when all is well */
static uint16_t told_mask; /* codes told since the fault began: each once */
static bool over;          /* what was told; the line that says so is not queued yet */
static uint32_t began_us;  /* the fault; what the counters were then: */
static uint32_t began_s;
static uint32_t began_lost;

static void begin_outage(uint32_t now_us)
{
    began_us = now_us;
    began_s = counters[COUNT_SECONDS];
    began_lost = counters[COUNT_LOST];
}

/* Microseconds wrap after 71 minutes: an outage of more than a minute is told in whole seconds. So do milliseconds. */
static void end_outage(uint32_t now_us)
{
    uint32_t seconds = counters[COUNT_SECONDS] - began_s;
    if (seconds < 60u) {
        sensor_watch_outage.ms = (now_us - began_us) / 1000u;
    } else {
        sensor_watch_outage.ms = seconds < MS_WRAP_S ? seconds * 1000u : UINT32_MAX;
    }
    sensor_watch_outage.lost = counters[COUNT_LOST] - began_lost;
}

/* The numbers of one that is over wait for the line that tells them. */
static bool outage_over(uint32_t now_us)
{
    if (!over && !replies_hold(REPLY_FAULT_END)) {
        end_outage(now_us);
        over = true;
    }
    return over;
}

/* The LED flashes for 65 ms in each of the first slots of 131 ms, of which a second has eight. */
static void show(uint8_t fault, uint32_t now_us)
{
    uint8_t half_slot = (uint8_t)(now_us >> FLASH_SHIFT);
    uint8_t slot = (half_slot >> 1) % FLASH_SLOTS;
    hal_led_set((half_slot & 1u) == 0 && slot < flash_u8(&flashes[fault]));
}

void sensor_watch_start(uint32_t now_us)
{
    told = (uint8_t)adxl345_fault();
    told_mask = (uint16_t)(1u << told);
    begin_outage(now_us);
}

static void tell(uint8_t fault, uint32_t now_us)
{
    uint16_t bit = (uint16_t)(1u << fault);
    bool in_words = settings.mode != MODE_PLOT;
    if (fault == ADXL345_FAULT_NONE) {
        if (outage_over(now_us) && in_words && replies_add(REPLY_FAULT_END, told)) {
            told = ADXL345_FAULT_NONE;
            told_mask = 0;
        }
    } else if (told_mask & bit) {
        told = fault;
    } else if (in_words && replies_add(REPLY_FAULT_BEGIN, fault)) {
        if (told == ADXL345_FAULT_NONE) {
            begin_outage(now_us);
        }
        told = fault;
        told_mask |= bit;
    }
}

void sensor_watch_pass(uint32_t now_us)
{
    uint8_t fault = (uint8_t)adxl345_fault();
    adxl345_phase_t phase = adxl345_phase();
    show(fault, now_us);
    if (phase == ADXL345_STOPPED) {
        told = ADXL345_FAULT_NONE; /* not mended, only not asked any more */
        told_mask = 0;
    }
    if (fault != ADXL345_FAULT_NONE) {
        over = false;
    }
    /* a stop and a go between two looks leave no fault either, but no sample yet */
    bool known = fault != ADXL345_FAULT_NONE || phase == ADXL345_STREAMING;
    if (known && fault != told) {
        tell(fault, now_us);
    }
}
