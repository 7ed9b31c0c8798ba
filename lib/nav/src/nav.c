/* Records in, state out: what is believed of a record, and the slot of an IMU record. */
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

#define RATE_MAX_RPS NAV_R(40.0)
#define FORCE_MAX_MPS2 NAV_R(400.0)
#define VELOCITY_MAX_MPS NAV_R(1e3)
#define POSITION_MAX_M NAV_R(1e6)
#define FIELD_MAX NAV_R(1e6)
#define GAP_MAX_S NAV_R(10.0)  /* beyond, what a gap may hold is said by the gate's re-acquisition */
#define CLOCK_GAP_US 1000000UL /* what a clock that began anew counts for */
#define HALF NAV_R(0.5)

/* NAV_TAKEN when all lie within +-limit. */
static nav_answer_t judged(const nav_real_t *values, uint8_t count, nav_real_t limit)
{
    nav_answer_t answer = NAV_TAKEN;
    for (uint8_t i = 0; i < count; i++) {
        if (!(values[i] >= -limit && values[i] <= limit)) {
            if (!(values[i] - values[i] <= 0)) { /* NaN, or infinite: the difference is NaN */
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

/* The numbers of a configuration, by their limits. */
typedef struct {
    nav_real_t sigma[4], walk[4], measured[4];
} noises_t;

static void noises_of(noises_t *out, const nav_config_t *c)
{
    *out = (noises_t){ { c->start_position_m, c->start_velocity_mps, c->start_attitude_rad, c->start_drift_rps },
                       { c->walk_position_m, c->walk_velocity_mps, c->walk_attitude_rad, c->walk_drift_rps },
                       { c->sigma_gps_velocity_mps, c->sigma_gps_position_m, c->sigma_down_m, c->sigma_field } };
}

static bool noises_are_legal(const noises_t *noises)
{
    for (uint8_t i = 0; i < 4U; i++) {
        if (!within(noises->sigma[i], 0, NAV_R(1e5)) || !within(noises->walk[i], 0, 1) ||
            !within(noises->measured[i], NAV_R(1e-4), NAV_R(1e5))) {
            return false;
        }
    }
    return true;
}

static bool rest_is_legal(const nav_config_t *c)
{
    const nav_state_t *start = &c->start;
    return (judged(start->quaternion, 4, 2) | judged(start->velocity_mps, 3, VELOCITY_MAX_MPS) |
            judged(start->position_m, 3, POSITION_MAX_M) | judged(start->gyro_drift_rps, 3, 1) |
            judged(c->field, 3, FIELD_MAX)) == NAV_TAKEN &&
           within(c->gravity_mps2, 1, 25) && (c->gate == 0 || within(c->gate, 1, 100)) && c->period_us >= 1000U &&
           c->period_us <= 100000U;
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

static void start_filter(nav_t *nav, const noises_t *noises, uint32_t period_us)
{
    nav_ud_start(nav->ud, noises->sigma);
    nav_noise_start(&nav->noise, noises->walk, period_us);
    for (uint8_t i = 0; i < 4U; i++) {
        nav->variance[i] = noises->measured[i] * noises->measured[i];
    }
}

bool nav_init(nav_t *nav, const nav_config_t *config)
{
    noises_t noises;
    noises_of(&noises, config);
    *nav = (nav_t){ 0 };
    nav->state = config->start;
    if (!noises_are_legal(&noises) || !rest_is_legal(config) || !nav_align_tau(nav->tau, config->field) ||
        !unit_quaternion(nav->state.quaternion)) {
        return false;
    }
    start_filter(nav, &noises, config->period_us);
    nav->gravity_mps2 = config->gravity_mps2;
    nav->gate_squared = config->gate * config->gate;
    nav->period_us = config->period_us;
    return true;
}

static void begin_at(nav_t *nav, uint32_t t_us)
{
    nav->t_us = t_us;
    nav->started = true;
    nav_jobs_forget(&nav->queue);
    nav_past_restart(&nav->past, &nav->state, t_us);
    nav_noise_restart(&nav->noise, t_us);
}

/* Strapdown and covariance to t_us with mean rate and force. */
static void advance(nav_t *nav, uint32_t t_us, const nav_real_t rate_rps[3], const nav_real_t force_mps2[3])
{
    nav_real_t step = nav_seconds(nav->t_us, t_us);
    nav_real_t dcm[9];
    nav_real_t rate[3];
    for (uint8_t i = 0; i < 3U; i++) {
        rate[i] = rate_rps[i] - nav->state.gyro_drift_rps[i];
    }
    nav_ins_dcm(dcm, nav->state.quaternion);
    nav_ins_step(&nav->state, nav->force_ned_mps2, dcm, rate, force_mps2, nav->gravity_mps2, step);
    nav_ud_phi(nav->ud, step, nav->force_ned_mps2, dcm);
    nav->t_us = t_us;
    nav_past_keep(&nav->past, &nav->state, t_us);
}

/* Records are missing: the mean of the last and this one stands for all of them. */
static void bridge(nav_t *nav, uint32_t t_us, const nav_real_t rate_rps[3], const nav_real_t force_mps2[3])
{
    nav_real_t rate[3];
    nav_real_t force[3];
    for (uint8_t i = 0; i < 3U; i++) {
        rate[i] = HALF * (nav->rate_rps[i] + rate_rps[i]);
        force[i] = HALF * (nav->force_mps2[i] + force_mps2[i]);
    }
    advance(nav, t_us, rate, force);
    nav_ins_unit(nav->state.quaternion);
}

/* Nothing is known of the time before: on with the velocity, and the covariance owes what it may hold. */
static void leap(nav_t *nav, uint32_t t_us, uint32_t gap_us)
{
    nav_real_t gap = (nav_real_t)gap_us * NAV_R(1e-6);
    gap = (gap < GAP_MAX_S) ? gap : GAP_MAX_S;
    for (uint8_t i = 0; i < 3U; i++) {
        nav->state.position_m[i] += gap * nav->state.velocity_mps[i];
    }
    nav_noise_owe(&nav->noise, gap);
    begin_at(nav, t_us);
}

static void remember(nav_t *nav, const nav_real_t rate_rps[3], const nav_real_t force_mps2[3])
{
    for (uint8_t i = 0; i < 3U; i++) {
        nav->rate_rps[i] = rate_rps[i];
        nav->force_mps2[i] = force_mps2[i];
    }
}

/* Longest step that is bridged. */
static uint32_t bridged_us(const nav_t *nav)
{
    uint32_t periods = 2U * nav->period_us;
    return (periods > NAV_BRIDGE_US) ? periods : NAV_BRIDGE_US;
}

/* Back in time: refused, until so many in a row say that the clock began anew. */
static nav_answer_t step_back(nav_t *nav, uint32_t t_us)
{
    nav->steps_back++;
    if (nav->steps_back < NAV_STEPS_BACK) {
        return NAV_BACKWARDS;
    }
    leap(nav, t_us, CLOCK_GAP_US);
    return NAV_GAP;
}

static nav_answer_t step_to(nav_t *nav, uint32_t t_us, const nav_real_t rate_rps[3], const nav_real_t force_mps2[3])
{
    uint32_t step_us = t_us - nav->t_us;
    if (nav_time_from(nav->t_us, t_us) <= 0) {
        return step_back(nav, t_us);
    }
    if (step_us > bridged_us(nav)) {
        leap(nav, t_us, step_us);
        return NAV_GAP;
    }
    if (step_us > nav->period_us + nav->period_us / 2U) {
        bridge(nav, t_us, rate_rps, force_mps2);
    } else {
        advance(nav, t_us, rate_rps, force_mps2);
    }
    return NAV_TAKEN;
}

nav_answer_t nav_imu(nav_t *nav, uint32_t t_us, const nav_real_t rate_rps[3], const nav_real_t force_mps2[3])
{
    nav_answer_t answer = worse(judged(rate_rps, 3, RATE_MAX_RPS), judged(force_mps2, 3, FORCE_MAX_MPS2));
    if (answer != NAV_TAKEN) {
        return counted(nav, answer);
    }
    if (!nav->started) {
        begin_at(nav, t_us - nav->period_us);
    }
    answer = step_to(nav, t_us, rate_rps, force_mps2);
    if (answer != NAV_BACKWARDS) {
        nav->steps_back = 0;
        remember(nav, rate_rps, force_mps2);
        nav_jobs_run(nav);
    }
    return counted(nav, answer);
}

nav_answer_t nav_gps(nav_t *nav, uint32_t t_us, const nav_real_t velocity_mps[3], const nav_real_t position_m[3])
{
    nav_answer_t answer = worse(judged(velocity_mps, 3, VELOCITY_MAX_MPS), judged(position_m, 3, POSITION_MAX_M));
    if (answer == NAV_TAKEN) {
        answer = nav_jobs_may(nav, NAV_GPS, t_us, NAV_LATE_US);
    }
    if (answer == NAV_TAKEN) {
        const nav_real_t values[6] = { velocity_mps[0], velocity_mps[1], velocity_mps[2],
                                       position_m[0],   position_m[1],   position_m[2] };
        nav_jobs_put(nav, NAV_GPS, t_us, values);
    }
    return counted(nav, answer);
}

nav_answer_t nav_down(nav_t *nav, uint32_t t_us, nav_real_t down_m)
{
    nav_answer_t answer = judged(&down_m, 1, POSITION_MAX_M);
    if (answer == NAV_TAKEN) {
        answer = nav_jobs_may(nav, NAV_DOWN, t_us, NAV_LATE_US);
    }
    if (answer == NAV_TAKEN) {
        nav_jobs_put(nav, NAV_DOWN, t_us, &down_m);
    }
    return counted(nav, answer);
}

nav_answer_t nav_field(nav_t *nav, uint32_t t_us, const nav_real_t field_body[3])
{
    nav_real_t direction[3] = { field_body[0], field_body[1], field_body[2] };
    nav_answer_t answer = judged(direction, 3, FIELD_MAX);
    if (answer == NAV_TAKEN && !nav_align_unit(direction)) {
        answer = NAV_NO_LENGTH;
    }
    if (answer == NAV_TAKEN) {
        answer = nav_jobs_may(nav, NAV_FIELD, t_us, NAV_FIELD_LATE_US);
    }
    if (answer == NAV_TAKEN) {
        nav_jobs_put(nav, NAV_FIELD, t_us, direction);
    }
    return counted(nav, answer);
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
    return within(square, NAV_R(0.999), NAV_R(1.001)) && finite_all(nav->state.velocity_mps, 3) &&
           finite_all(nav->state.position_m, 3) && finite_all(nav->state.gyro_drift_rps, 3) &&
           finite_all(nav->ud, NAV_PACKED) && nav_ud_positive(nav->ud);
}
