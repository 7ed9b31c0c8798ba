/* What the commands do: settings judged, taken, kept, and what follows from them. */
#include "adxl345.h"
#include "app/app.h"
#include "base/health.h"
#include "control/app_state.h"
#include "control/measure.h"
#include "path/pipeline.h"
#include "settings/settings.h"
#include "settings/settings_kept.h"
#include "settings/settings_table.h"
#include "settings/store.h"

void app_configure(bool anew)
{
    app.changes |= CHANGE_MEASURE;
    if (anew) {
        app.changes |= CHANGE_COLD;
    }
    if (app.sampling) {
        app_start_sensor();
    }
}

/* The pipeline follows when the driver has delivered the last sample of the old configuration. */
static void change_sensor(void)
{
    measure_abort();
    if (app.sampling) {
        app.changes |= CHANGE_CONFIG;
        app_start_sensor();
    }
}

static void change_baud(void)
{
    app.stage = STAGE_BAUD;
    health_pause_filtering(APP_HOLD_PASSES);
}

/* settings_table.h says what a change starts; what follows by arithmetic costs two divisions. */
static void follow(uint8_t starts)
{
    settings_follow();
    if (starts & STARTS_CALIBRATION) {
        pipeline_calibrate(&settings.calibration);
    }
    if (starts & STARTS_FILTER) {
        app.changes |= CHANGE_FILTER;
    }
    if (starts & STARTS_SENSOR) {
        change_sensor();
    }
    if (starts & STARTS_LINE) {
        change_baud();
    }
}

setting_answer_t app_set(uint8_t which, const char *text)
{
    uint8_t starts;
    setting_answer_t answer = setting_set(which, text, &starts);
    if (answer == SETTING_TAKEN) {
        follow(starts);
    }
    return answer;
}

void app_restore(bool saved)
{
    uint32_t old_baud = settings.baud;
    if (saved) {
        settings_load();
    } else {
        settings_defaults();
    }
    follow(STARTS_FILTER | STARTS_SENSOR | STARTS_CALIBRATION | (settings.baud != old_baud ? STARTS_LINE : 0));
}

bool app_save(void)
{
    return !app.sampling && store_save_begin();
}

void app_sample(bool wanted)
{
    app.sampling = wanted;
    measure_abort();
    if (wanted) {
        app.changes |= CHANGE_COLD;
        app_start_sensor();
    } else {
        adxl345_stop();
    }
}
