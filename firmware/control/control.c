/* See control.h. */
#include "control/control.h"

#include "adxl345.h"
#include "base/health.h"
#include "base/notices.h"
#include "control/measure.h"
#include "path/coast.h"
#include "path/pipeline.h"
#include "path/silence.h"
#include "settings/settings.h"
#include "settings/settings_kept.h"
#include "settings/store.h"

/*
 * What the sample path still has to follow. FILTER applies to all samples to come; the others wait until the samples of
 * the old configuration are through. COLD: filters restart. MEASURE: measure_configured is due.
 */
enum { CHANGE_FILTER = 1, CHANGE_CONFIG = 2, CHANGE_COLD = 4, CHANGE_MEASURE = 8 };

static struct {
    bool sampling; /* wanted: after go or start-up, not after stop */
    bool line_waits;
    bool limit_told; /* NOTICE_LIMITED, since the sample path was changed */
    uint8_t changes; /* still to be followed */
} control;

/* With the settings' configuration, or the one that a measurement needs. */
static void start_sensor(void)
{
    adxl345_config_t config = { settings()->rate_dhz, settings()->range_g, false, settings()->address };
    measure_configure(&config);
    adxl345_start(&config);
}

static void change_pipeline(void)
{
    control.limit_told = false;
    pipeline_change(&settings()->choice, settings()->rate_dhz, settings()->range_g);
}

/* Deriving what depends on the settings costs two divisions. */
static void follow(uint8_t starts)
{
    settings_follow();
    if (starts & STARTS_CALIBRATION) {
        pipeline_calibrate(&settings()->calibration);
    }
    if (starts & STARTS_FILTER) {
        control.changes |= CHANGE_FILTER;
    }
    if (starts & STARTS_SENSOR) {
        measure_abort();
        adxl345_set_i2c((adxl345_i2c_t)settings()->i2c);
        if (control.sampling) {
            control.changes |= CHANGE_CONFIG;
            start_sensor();
        }
    }
    if (starts & STARTS_LINE) {
        control.line_waits = true;
        health_pause_filtering(HEALTH_HOLD_PASSES);
    }
}

setting_answer_t control_set(uint8_t which, const char *text)
{
    uint8_t starts;
    setting_answer_t answer = setting_set(which, text, &starts);
    if (answer == SETTING_TAKEN) {
        follow(starts);
    }
    return answer;
}

void control_restore(bool saved)
{
    uint32_t old_baud = settings()->baud;
    if (saved) {
        settings_load();
    } else {
        settings_defaults();
    }
    follow(STARTS_FILTER | STARTS_SENSOR | STARTS_CALIBRATION | (settings()->baud != old_baud ? STARTS_LINE : 0));
}

bool control_save(void)
{
    return !measure_runs() && store_save_begin();
}

void control_sample(bool wanted)
{
    control.sampling = wanted;
    measure_abort();
    if (wanted) {
        control.changes |= CHANGE_COLD;
        start_sensor();
    } else {
        adxl345_stop();
    }
}

bool control_line_waits(void)
{
    return control.line_waits;
}

void control_line_changed(void)
{
    control.line_waits = false;
}

/* Configures the sensor as a measurement asks. */
static void follow_measurement(void)
{
    control.changes |= CHANGE_MEASURE;
    if (control.sampling) {
        start_sensor();
    }
}

/* The changes that are due: not all while samples of the old configuration are in flight. */
static uint8_t take_changes(void)
{
    bool old_samples = adxl345_phase() == ADXL345_QUIESCING || adxl345_queued() != 0;
    uint8_t now = control.changes;
    if (old_samples) { /* they have their own rate and range */
        now = (now & CHANGE_CONFIG) ? 0 : now & CHANGE_FILTER;
    }
    control.changes = (uint8_t)(control.changes & ~now);
    if ((now & CHANGE_MEASURE) && measure_configured()) {
        now |= CHANGE_COLD;
    }
    return now;
}

bool control_follow(uint32_t now_us)
{
    if (measure_asks()) {
        follow_measurement();
    }
    if (control.changes == 0) {
        return false;
    }
    uint8_t now = take_changes();
    if ((now & CHANGE_COLD) || ((now & CHANGE_CONFIG) && !silence_holds())) { /* else more is lost, and rows go on */
        coast_wait(now_us);
    }
    if (now & CHANGE_COLD) {
        pipeline_forget();
    }
    if (now & (CHANGE_FILTER | CHANGE_CONFIG | CHANGE_COLD)) {
        change_pipeline();
    }
    return now != 0;
}

/* Estimates of R move the limit: it is reported once, not each time. */
void control_second(void)
{
    if (control.limit_told || !pipeline_changed() || settings()->mode == MODE_PLOT) {
        return;
    }
    bool limited = false;
    const tilt_axis_t *axis = pipeline_axes();
    for (uint8_t left = 3; left != 0; left--, axis++) {
        limited |= filter_limited(&axis->filter);
    }
    if (limited) {
        control.limit_told = notices_add(NOTICE_LIMITED, 0);
    }
}

/* No sample of another configuration is on its way, so all changes are followed at once. */
void control_start(void)
{
    control.line_waits = false;
    control.sampling = true;
    follow(STARTS_SENSOR | STARTS_CALIBRATION);
    control.changes = 0;
    pipeline_forget();
    change_pipeline();
}
