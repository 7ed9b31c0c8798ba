/* Which samples a measurement takes, and what ends it. Its texts are in measure_lines.c. */
#include "control/measure.h"

#include "base/counters.h"
#include "base/notices.h"
#include "control/calibrate.h"
#include "hal_sleep.h"
#include "machine.h"
#include "settings/settings.h"

enum { AXES = 3 };

/* For one position of cal6, with the time to turn the board; 256 samples at 12.5 Hz take 20.5 s, a self-test 1.4 s. */
enum { SECONDS_MAX = 120 };

/* The current step. */
typedef enum {
    STEP_IDLE,
    STEP_TOLD,    /* the reply is in the queue */
    STEP_TELL,    /* the reply waits for room */
    STEP_BACK,    /* self-test: the result is known, the settings' configuration is being restored */
    STEP_SOLVE,   /* cal6: all positions are known */
    STEP_COLLECT, /* samples that the filters get too */
    STEP_PLAIN,   /* self-test: without the force */
    STEP_FORCED   /* with it */
} step_t;

static struct measure {
    union {
        rest_t rest;
        calibration_six_t six; /* in STEP_SOLVE */
    };
    int16_t result_lsb_q4[AXES]; /* the mean; of a self-test the second mean minus the first */
    uint8_t kind;                /* notice_kind_t */
    uint8_t step;                /* step_t */
    uint8_t outcome;             /* measure_outcome_t, set from STEP_BACK and STEP_TELL on */
    uint8_t skip;                /* samples still to skip */
    uint8_t began_s;
    bool asks;  /* for another configuration of the sensor, or for that of the settings */
    bool waits; /* until samples have it */
    bool borrows;
} measure;

/* With its address in a register, each access takes half the code. */
static inline struct measure *here(void)
{
    struct measure *m = &measure;
    MACHINE_POINTER(m);
    return m;
}

void measure_reset(void)
{
    measure.step = STEP_IDLE;
    measure.asks = false;
    measure.waits = false;
    measure.borrows = false;
}

bool measure_borrows(void)
{
    return measure.borrows;
}

void measure_configure(adxl345_config_t *config)
{
    if (measure.step >= STEP_PLAIN) {
        config->rate_dhz = MEASURE_SELFTEST_DHZ;
        config->range_g = MEASURE_SELFTEST_G;
        config->self_test = measure.step == STEP_FORCED;
    }
}

static void enter(struct measure *m, step_t step)
{
    m->step = (uint8_t)step;
    m->skip = 0;
    if (step != STEP_COLLECT) {
        m->skip = MEASURE_SETTLE;
        m->asks = true;
        m->waits = true;
    }
}

bool measure_asks(void)
{
    bool asks = measure.asks;
    measure.asks = false;
    return asks;
}

static uint8_t second(void)
{
    return (uint8_t)counted(COUNT_SECONDS);
}

static void collect(step_t step)
{
    struct measure *m = here();
    if (step != STEP_FORCED) {
        for (uint8_t axis = 0; axis < AXES; axis++) {
            m->result_lsb_q4[axis] = 0;
        }
    }
    rest_start(&m->rest);
    enter(m, step);
}

static void end(measure_outcome_t outcome)
{
    struct measure *m = here();
    m->outcome = (uint8_t)outcome;
    if (m->step <= STEP_COLLECT) {
        m->step = STEP_TELL;
    } else {
        enter(m, STEP_BACK);
    }
}

bool measure_configured(void)
{
    struct measure *m = here();
    bool back = m->step == STEP_BACK;
    m->borrows = !back;
    m->waits = false;
    if (back) {
        m->step = STEP_TELL;
    }
    return back;
}

bool measure_runs(void)
{
    return measure.step != STEP_IDLE;
}

bool measure_start(uint8_t kind)
{
    if (measure_runs()) {
        return false;
    }
    measure.kind = kind;
    measure.began_s = second();
    calibrate_start();
    collect(kind == NOTICE_SELFTEST ? STEP_PLAIN : STEP_COLLECT);
    return true;
}

void measure_abort(void)
{
    if (measure.step >= STEP_SOLVE) {
        end(MEASURE_ABORTED);
    }
}

/* It takes too long, no samples come, or there was a gap. */
static bool failed(void)
{
    uint8_t seconds = (uint8_t)(second() - measure.began_s);
    return seconds > SECONDS_MAX || adxl345_fault() != ADXL345_FAULT_NONE || adxl345_interrupted() ||
           adxl345_phase() == ADXL345_STOPPED;
}

void measure_stop(void)
{
    if (measure.kind == NOTICE_CAL6 && measure.step >= STEP_SOLVE) {
        measure.step = STEP_IDLE;
    }
}

static void solve(struct measure *m)
{
    measure_outcome_t outcome = calibrate_step(&m->six);
    if (outcome != MEASURE_BEGUN) {
        end(outcome);
    }
    hal_wake();
}

void measure_pass(void)
{
    struct measure *m = here();
    if (m->step == STEP_SOLVE) {
        solve(m);
    }
    if (m->step >= STEP_COLLECT && failed()) {
        measure_abort();
    }
    if (m->step == STEP_TELL && notices_add((notice_kind_t)m->kind, m->outcome)) {
        m->step = STEP_TOLD;
    }
    if (m->step == STEP_TOLD && notices_empty()) {
        m->step = STEP_IDLE;
    }
}

/* cal6: the board is being turned; what is reported is that it lies still. */
static void board_moves(void)
{
    if (measure.kind == NOTICE_CAL6) {
        collect(STEP_COLLECT);
    } else {
        end(MEASURE_MOVED);
    }
}

/* A position that cannot be reported is taken again. */
static void calibrate(struct measure *m)
{
    measure_outcome_t outcome = MEASURE_UNCHANGED;
    if (notices_room()) {
        outcome = calibrate_take(m->kind, m->result_lsb_q4);
    }
    if (outcome == MEASURE_POSITION || outcome == MEASURE_REPEATED) {
        (void)notices_add(NOTICE_CAL6, outcome);
        m->began_s = second();
        outcome = MEASURE_UNCHANGED;
    }
    if (outcome == MEASURE_UNCHANGED) {
        collect(STEP_COLLECT);
    } else if (outcome == MEASURE_BEGUN) {
        m->step = STEP_SOLVE;
        calibrate_start_six(&m->six);
        hal_wake();
    } else {
        end(outcome);
    }
}

/* All samples have come, or one of them shows that the board moves. */
static void collected(struct measure *m)
{
    if (!rest_still(&m->rest, m->step == STEP_COLLECT ? settings()->rate_dhz : MEASURE_SELFTEST_DHZ)) {
        board_moves();
        return;
    }
    for (uint8_t axis = 0; axis < AXES; axis++) {
        int16_t *result = &m->result_lsb_q4[axis];
        *result = (int16_t)((uint16_t)rest_mean_lsb_q4(&m->rest.axes[axis]) - (uint16_t)*result);
    }
    if (m->step == STEP_PLAIN) {
        collect(STEP_FORCED);
    } else if (m->kind >= NOTICE_TARE) {
        calibrate(m);
    } else {
        end(MEASURE_DONE);
    }
}

/* At 200, 400 and 800 Hz only every second, fourth and eighth sample, so that they span as much time. */
static void take(struct measure *m, const int16_t lsb[3])
{
    if (m->step == STEP_COLLECT) {
        m->skip = (uint8_t)(settings()->rate_dhz >> 10);
    }
    if (rest_add(&m->rest, lsb)) {
        collected(m);
    }
}

bool measure_sample(const int16_t lsb[3])
{
    struct measure *m = here();
    bool borrowed = m->borrows;
    if (m->step >= STEP_COLLECT && !m->waits) {
        if (m->skip != 0) {
            m->skip--;
        } else {
            take(m, lsb);
        }
    }
    return borrowed;
}

const rest_t *measure_rest(void)
{
    return &measure.rest;
}

int16_t measure_result_lsb_q4(uint8_t axis)
{
    return measure.result_lsb_q4[axis];
}
