/* Records in, state out: checks of a record, and the slot of an IMU record. */
#include "nav.h"
#include "nav_align.h"
#include "nav_ins.h"
#include "nav_jobs.h"
#include "nav_noise.h"
#include "nav_past.h"
#include "nav_root.h"
#include "nav_time.h"
#include "nav_ud.h"
#include "nav_vector.h"

#include <stddef.h>

#define RATE_MAX_RPS NAV_R(40.0)
#define FORCE_MAX_MPS2 NAV_R(400.0)
#define VELOCITY_MAX_MPS NAV_R(1e3)
#define POSITION_MAX_M NAV_R(1e6)
#define FIELD_MAX NAV_R(1e6)
#define GAP_MAX_S NAV_R(10.0)  /* for longer gaps the gate's re-acquisition covers the rest */
#define CLOCK_GAP_US 1000000UL /* assumed gap if a clock has restarted */
#define ONLY_ONE 0x80U /* in strays: the only time accepted so far is the first record's, which may be the wrong one */
#define HALF NAV_R(0.5)

/* NAV_TAKEN if all are within +-limit. */
static nav_answer_t judged(const nav_real_t *values, uint8_t count, nav_real_t limit)
{
    nav_answer_t answer = NAV_TAKEN;
    for (uint8_t i = 0; i < count; i++) {
        if (!(values[i] >= -limit && values[i] <= limit)) {
            if (!(values[i] - values[i] <= 0)) { /* NaN or infinite: the difference is NaN */
                return NAV_NOT_FINITE;
            }
            answer = NAV_OUT_OF_RANGE;
        }
    }
    return answer;
}

static nav_answer_t counted(nav_t *nav, nav_answer_t answer)
{
    if (nav->counts.answer[answer] < UINT16_MAX) {
        nav->counts.answer[answer]++;
    }
    return answer;
}

static nav_answer_t worse(nav_answer_t a, nav_answer_t b)
{
    return (a == NAV_NOT_FINITE || b == NAV_TAKEN) ? a : b;
}

static bool within(nav_real_t value, nav_real_t low, nav_real_t high)
{
    return value >= low && value <= high;
}

/* The consecutive numbers of a configuration: sigmas of the start, random walks, sigmas of the sensors. */
enum { STARTS = 0, WALKS = 4, SENSORS = 8, NUMBERS = 12 };
_Static_assert(offsetof(nav_config_t, gate) - offsetof(nav_config_t, start_position_m) == sizeof(nav_real_t[NUMBERS]),
               "no other field lies between the first sigma and the gate");

static const nav_real_t *numbers_of(const nav_config_t *c)
{
    return (const nav_real_t *)(const void *)((const char *)c + offsetof(nav_config_t, start_position_m));
}

static bool is_legal(const nav_config_t *c)
{
    const nav_real_t *numbers = numbers_of(c);
    const nav_state_t *start = &c->start;
    for (uint8_t i = 0; i < NUMBERS; i++) {
        if (!within(numbers[i], (i < SENSORS) ? 0 : NAV_R(1e-4), NAV_R(1e5))) {
            return false;
        }
    }
    return (judged(start->velocity_mps, 3, VELOCITY_MAX_MPS) | judged(start->position_m, 3, POSITION_MAX_M) |
            judged(start->gyro_drift_rps, 3, 1)) == NAV_TAKEN &&
           within(c->gravity_mps2, 1, 25) && within(c->gate, 0, 100) && !(c->gate > 0 && c->gate < 1) &&
           c->period_us >= 1000U && c->period_us <= 100000U;
}

static bool unit_quaternion(nav_real_t q[4])
{
    nav_real_t length = nav_root(q[0] * q[0] + nav_dot(q + 1, q + 1));
    if (!within(length, HALF, 2)) {
        return false;
    }
    for (uint8_t i = 0; i < 4U; i++) {
        q[i] /= length;
    }
    return true;
}

bool nav_init(nav_t *nav, const nav_config_t *config)
{
    const nav_real_t *numbers = numbers_of(config);
    *nav = (nav_t){ 0 };
    nav->state = config->start;
    if (!is_legal(config) || !nav_align_tau(nav->tau, config->field) || !unit_quaternion(nav->state.quaternion)) {
        return false;
    }
    nav_ud_start(nav->ud, numbers + STARTS);
    nav_noise_start(&nav->noise, numbers + WALKS, config->period_us);
    for (uint8_t i = 0; i < 4U; i++) {
        nav->variance[i] = numbers[SENSORS + i] * numbers[SENSORS + i];
    }
    nav->gravity_mps2 = config->gravity_mps2;
    nav->gate_squared = config->gate * config->gate;
    nav->period_us = config->period_us;
    return true;
}

static void begin_at(nav_t *nav, uint32_t t_us)
{
    nav->t_us = t_us;
    nav_jobs_forget(&nav->queue);
    nav_past_restart(&nav->past, &nav->state, t_us);
    nav_noise_restart(&nav->noise, t_us);
}

/* Stores this record as the last one; rate and force become its own, or the mean with the previous one if bridged. */
static void read_record(nav_t *nav, nav_real_t rate[3], nav_real_t force[3], bool bridged)
{
    for (uint8_t i = 0; i < 3U; i++) {
        nav_real_t now = rate[i];
        nav_real_t pushed = force[i];
        if (bridged) {
            rate[i] = HALF * (nav->rate_rps[i] + now);
            force[i] = HALF * (nav->force_mps2[i] + pushed);
        }
        nav->rate_rps[i] = now;
        nav->force_mps2[i] = pushed;
    }
}

/* Propagates strapdown and covariance to t_us with mean rate and force. */
static void advance(nav_t *nav, uint32_t t_us, nav_real_t rate[3], const nav_real_t force[3])
{
    nav_real_t step = nav_seconds(nav->t_us, t_us);
    nav_real_t dcm[9];
    for (uint8_t i = 0; i < 3U; i++) {
        rate[i] -= nav->state.gyro_drift_rps[i];
    }
    nav_ins_dcm(dcm, nav->state.quaternion);
    nav_ins_step(&nav->state, nav->force_ned_mps2, dcm, rate, force, nav->gravity_mps2, step);
    nav_ud_phi(nav->ud, step, nav->force_ned_mps2, dcm);
    nav->t_us = t_us;
    nav_past_keep(&nav->past, &nav->state, t_us);
}

/* Nothing is known about the interval: moves on with the velocity, and the covariance owes what may have happened. */
static void leap(nav_t *nav, uint32_t t_us, uint32_t gap_us)
{
    nav_real_t gap = (nav_real_t)gap_us * NAV_R(1e-6);
    gap = (gap < GAP_MAX_S) ? gap : GAP_MAX_S;
    nav_add_scaled(nav->state.position_m, gap, nav->state.velocity_mps);
    nav_noise_owe(&nav->noise, gap);
    begin_at(nav, t_us);
}

/* Longest step that is bridged. */
static uint32_t bridged_us(const nav_t *nav)
{
    uint32_t periods = 2U * nav->period_us;
    return (periods > NAV_BRIDGE_US) ? periods : NAV_BRIDGE_US;
}

/*
 * A time that does not continue from the last may be a single wrong stamp, and accepting it would move the position by
 * seconds of flight. It is a gap if the next record continues from it. Times that go back may be late records, several
 * in a row.
 */
static nav_answer_t stray(nav_t *nav, uint32_t t_us, uint32_t step_us)
{
    bool unconfirmed_start = (nav->strays & ONLY_ONE) != 0U;
    uint8_t before = nav->strays & (uint8_t)~ONLY_ONE;
    bool ahead = (int32_t)step_us > 0;
    bool confirmed = ahead && before != 0U && t_us - nav->stray_us - 1U < bridged_us(nav);
    nav->stray_us = t_us;
    nav->strays++;
    if (!confirmed && before < NAV_STRAYS - 1) {
        return ahead ? NAV_OUT_OF_RANGE : NAV_BACKWARDS;
    }
    if (unconfirmed_start) {
        step_us = NAV_BRIDGE_US;
    } else if (!ahead) {
        step_us = CLOCK_GAP_US;
    }
    leap(nav, t_us, step_us);
    return NAV_GAP;
}

static nav_answer_t step_to(nav_t *nav, uint32_t t_us, nav_real_t rate[3], nav_real_t force[3])
{
    uint32_t step_us = t_us - nav->t_us;
    if (step_us - 1U >= bridged_us(nav)) {
        return stray(nav, t_us, step_us);
    }
    bool leapt = nav->stray_us == nav->t_us; /* the last record read is from before the gap */
    read_record(nav, rate, force, !leapt && step_us > nav->period_us + nav->period_us / 2U);
    advance(nav, t_us, rate, force);
    return NAV_TAKEN;
}

nav_answer_t nav_imu(nav_t *nav, uint32_t t_us, const nav_real_t rate_rps[3], const nav_real_t force_mps2[3])
{
    nav_real_t rate[3] = { rate_rps[0], rate_rps[1], rate_rps[2] };
    nav_real_t force[3] = { force_mps2[0], force_mps2[1], force_mps2[2] };
    nav_answer_t answer = worse(judged(rate, 3, RATE_MAX_RPS), judged(force, 3, FORCE_MAX_MPS2));
    if (answer == NAV_TAKEN) {
        uint8_t strays = 0;
        if (nav_past_empty(&nav->past)) {
            begin_at(nav, t_us - nav->period_us);
            strays = ONLY_ONE;
        }
        answer = step_to(nav, t_us, rate, force);
        if (answer == NAV_TAKEN || answer == NAV_GAP) {
            nav->strays = strays;
            nav_jobs_run(nav);
        }
    }
    return counted(nav, answer);
}

/* Queues values that passed the checks, if their time fits. */
static nav_answer_t queued(nav_t *nav, nav_answer_t answer, nav_sensor_t sensor, uint32_t t_us,
                           const nav_real_t *values)
{
    if (answer == NAV_TAKEN) {
        answer = nav_jobs_may(nav, sensor, t_us);
    }
    if (answer == NAV_TAKEN) {
        nav_jobs_put(nav, sensor, t_us, values);
    }
    return counted(nav, answer);
}

nav_answer_t nav_gps(nav_t *nav, uint32_t t_us, const nav_real_t velocity_mps[3], const nav_real_t position_m[3])
{
    nav_real_t values[6];
    for (uint8_t i = 0; i < 3U; i++) {
        values[i] = velocity_mps[i];
        values[3U + i] = position_m[i];
    }
    nav_answer_t answer = worse(judged(values, 3, VELOCITY_MAX_MPS), judged(values + 3, 3, POSITION_MAX_M));
    return queued(nav, answer, NAV_GPS, t_us, values);
}

nav_answer_t nav_down(nav_t *nav, uint32_t t_us, nav_real_t down_m)
{
    return queued(nav, judged(&down_m, 1, POSITION_MAX_M), NAV_DOWN, t_us, &down_m);
}

nav_answer_t nav_field(nav_t *nav, uint32_t t_us, const nav_real_t field_body[3])
{
    nav_real_t direction[3] = { field_body[0], field_body[1], field_body[2] };
    nav_answer_t answer = judged(direction, 3, FIELD_MAX);
    if (answer == NAV_TAKEN && !nav_align_unit(direction)) {
        answer = NAV_NO_LENGTH;
    }
    return queued(nav, answer, NAV_FIELD, t_us, direction);
}

const nav_state_t *nav_state(const nav_t *nav)
{
    return &nav->state;
}

void nav_variances(const nav_t *nav, nav_real_t variance[NAV_STATES])
{
    nav_ud_variances(nav->ud, variance);
}

const nav_counts_t *nav_counts(const nav_t *nav)
{
    return &nav->counts;
}

uint8_t nav_queued(const nav_t *nav)
{
    uint8_t count = 0;
    for (uint16_t waits = nav->queue.waits; waits != 0U; waits >>= 1U) {
        count = (uint8_t)(count + (waits & 1U));
    }
    return count;
}

static bool finite_all(const nav_real_t *values, uint8_t count)
{
    return judged(values, count, NAV_R(3e38)) == NAV_TAKEN;
}

bool nav_healthy(const nav_t *nav)
{
    const nav_real_t *q = nav->state.quaternion;
    nav_real_t square = q[0] * q[0] + nav_dot(q + 1, q + 1);
    return within(square, NAV_R(0.99), NAV_R(1.01)) && finite_all(nav->state.velocity_mps, 3) &&
           finite_all(nav->state.position_m, 3) && finite_all(nav->state.gyro_drift_rps, 3) &&
           finite_all(nav->ud, NAV_PACKED) && nav_ud_positive(nav->ud);
}
