/* What the commands do: settings judged, taken, kept, and what follows from them. */
#include "adxl345.h"
#include "app.h"
#include "app_state.h"
#include "health.h"
#include "measure.h"
#include "parameters.h"
#include "pipeline.h"
#include "settings.h"
#include "settings_kept.h"
#include "store.h"

app_answer_t app_set_filter(uint8_t filter_kind)
{
    if (!settings_fit(filter_kind, settings.rate_dhz)) {
        return APP_TOO_SLOW;
    }
    settings_take_filter(filter_kind);
    settings_follow();
    app.changes |= CHANGE_FILTER;
    return APP_DONE;
}

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

app_answer_t app_set_rate(uint16_t rate_dhz)
{
    if (!settings_doubled(SETTINGS_RATE_MIN_DHZ, SETTINGS_RATE_MAX_DHZ, rate_dhz)) {
        return APP_ILLEGAL;
    }
    if (!settings_fit(settings.filter, rate_dhz)) {
        return APP_TOO_SLOW;
    }
    if (settings.rate_dhz != rate_dhz) {
        settings.rate_dhz = rate_dhz;
        settings_follow();
        change_sensor();
    }
    return APP_DONE;
}

app_answer_t app_set_range(uint16_t range_g)
{
    if (!settings_doubled(SETTINGS_RANGE_MIN_G, SETTINGS_RANGE_MAX_G, range_g)) {
        return APP_ILLEGAL;
    }
    if (settings.range_g != range_g) {
        settings.range_g = (uint8_t)range_g;
        change_sensor();
    }
    return APP_DONE;
}

app_answer_t app_set_every(uint16_t every)
{
    if (every == 0 || every > SETTINGS_EVERY_MAX) {
        return APP_ILLEGAL;
    }
    settings.every = every;
    return APP_DONE;
}

bool app_set_parameter(uint8_t which, const uint32_t values[PARAMETERS_AXES])
{
    if (!parameters_set(which, values)) {
        return false;
    }
    if (parameters_numbers(which) == 1) {
        app.changes |= CHANGE_FILTER;
    }
    return true;
}

static void change_baud(void)
{
    app.stage = STAGE_BAUD;
    health_pause_filtering(APP_HOLD_PASSES);
}

app_answer_t app_set_baud(uint32_t baud)
{
    if (!settings_baud_valid(baud)) {
        return APP_ILLEGAL;
    }
    settings.baud = baud;
    settings_follow();
    change_baud();
    return APP_DONE;
}

/* All settings may be others. */
static void apply_settings(uint32_t old_baud)
{
    pipeline_calibrate(&settings.calibration);
    settings_follow();
    app.changes |= CHANGE_FILTER;
    change_sensor();
    if (settings.baud != old_baud) {
        change_baud();
    }
}

void app_load(void)
{
    uint32_t old_baud = settings.baud;
    settings_load();
    apply_settings(old_baud);
}

void app_defaults(void)
{
    uint32_t old_baud = settings.baud;
    settings_defaults();
    apply_settings(old_baud);
}

bool app_save(void)
{
    return !app.sampling && store_save_begin();
}

void app_set_address(uint8_t address)
{
    settings.address = address;
    change_sensor();
}

void app_set_mode(uint8_t mode)
{
    settings.mode = mode;
}

void app_stop(void)
{
    app.sampling = false;
    measure_abort();
    adxl345_stop();
}

void app_go(void)
{
    app.sampling = true;
    measure_abort();
    app.changes |= CHANGE_COLD;
    app_start_sensor();
}
