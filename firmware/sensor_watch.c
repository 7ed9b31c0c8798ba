/* When a fault is told, and the rows without samples. The words are in reply_texts.h. */
#include "sensor_watch.h"

#include <stdbool.h>

#include "adxl345.h"
#include "hal_led.h"
#include "hal_time.h"
#include "pipeline.h"
#include "replies.h"
#include "rows.h"
#include "settings.h"

#define HELD_ROW_US 100000ul

static uint8_t told;       /* fault code of the last line, NONE when all is well */
static uint16_t told_mask; /* codes told since the fault began: each once */
static uint32_t next_row_us;

void sensor_watch_start(uint32_t now_us)
{
    told = (uint8_t)adxl345_fault();
    told_mask = (uint16_t)(1u << told);
    next_row_us = now_us + HELD_ROW_US;
}

static void tell(uint8_t fault)
{
    uint16_t bit = (uint16_t)(1u << fault);
    if (fault == ADXL345_FAULT_NONE) {
        if (replies_add(REPLY_FAULT_END, told)) {
            told = ADXL345_FAULT_NONE;
            told_mask = 0;
        }
    } else if (told_mask & bit) {
        told = fault;
    } else if (replies_add(REPLY_FAULT_BEGIN, fault)) {
        told = fault;
        told_mask |= bit;
    }
}

void sensor_watch_pass(uint32_t now_us)
{
    uint8_t fault = (uint8_t)adxl345_fault();
    adxl345_phase_t phase = adxl345_phase();
    hal_led_set(fault != ADXL345_FAULT_NONE);
    if (phase == ADXL345_STOPPED) {
        told = ADXL345_FAULT_NONE; /* not mended, only not asked any more */
        told_mask = 0;
    }
    /* a stop and a go between two looks leave no fault either, but no sample yet */
    bool known = fault != ADXL345_FAULT_NONE || phase == ADXL345_STREAMING;
    if (known && fault != told && settings.mode != MODE_PLOT) {
        tell(fault);
    }
    if (fault == ADXL345_FAULT_NONE) {
        next_row_us = now_us + HELD_ROW_US;
        return;
    }
    pipeline_flag(ROW_FAULT);
    if (hal_time_reached(now_us, next_row_us)) {
        next_row_us += HELD_ROW_US;
        rows_held(now_us);
    }
}
