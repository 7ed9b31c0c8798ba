/*
 * The queue. A measurement of epoch e that is used at time t = e + age is compared with the state of that epoch. To
 * first order in the age the errors were dr(e) = dr - age dv and dv(e) = dv - age f x mu, which gives the rows of H.
 * The computed value for the epoch is fixed when the measurement is taken in. A correction x made later changes it by h
 * x, with the row h at that time, and this is subtracted from the waiting innovations. So the scalars of an epoch may
 * be used one after another, at later and later times: in exact numbers, without noise in between and to first order in
 * the age, the result is that of using all at once, because each scalar still measures the same error at the epoch.
 */
#include "nav_jobs.h"
#include "nav_align.h"
#include "nav_ins.h"
#include "nav_noise.h"
#include "nav_past.h"
#include "nav_time.h"
#include "nav_ud.h"
#include "nav_vector.h"

enum { VELOCITY = 0, POSITION = 3, DOWN = 6, FIELD = 7, ROW_AGAIN = 3 };

static uint16_t bit(uint8_t i)
{
    return (uint16_t)((uint16_t)1U << i);
}

static uint8_t first_of(uint8_t sensor)
{
    return (sensor == NAV_GPS) ? VELOCITY : (uint8_t)(DOWN - NAV_DOWN + sensor);
}

static uint8_t sensor_of(uint8_t scalar)
{
    return (scalar < DOWN) ? NAV_GPS : (uint8_t)((scalar == DOWN) ? NAV_DOWN : NAV_FIELD);
}

/* The bits of a sensor's scalars. */
static uint16_t bits_of(uint8_t sensor)
{
    return (sensor == NAV_GPS) ? 0x3FU : (uint16_t)((sensor == NAV_DOWN) ? 0x40U : 0x180U);
}

void nav_jobs_forget(nav_queue_t *queue)
{
    queue->waits = 0;
    queue->arrived = 0;
    queue->seen = 0;
    queue->in_a_row = 0;
}

nav_answer_t nav_jobs_may(const nav_t *nav, nav_sensor_t sensor, uint32_t t_us)
{
    const nav_queue_t *queue = &nav->queue;
    int32_t age = nav_time_from(t_us, nav->t_us);
    if (nav_past_empty(&nav->past) || age < -(int32_t)NAV_BRIDGE_US) {
        return NAV_GAP;
    }
    if (age > ((sensor == NAV_FIELD) ? (int32_t)NAV_FIELD_LATE_US : (int32_t)NAV_LATE_US) ||
        !nav_past_reaches(&nav->past, t_us)) {
        return NAV_LATE;
    }
    /* a last epoch that appears to be far ahead is half a clock period old */
    int32_t back = nav_time_from(t_us, queue->t_us[sensor]);
    if ((queue->seen & bit(sensor)) != 0U && back >= 0 && back <= (int32_t)(NAV_LATE_US + NAV_BRIDGE_US)) {
        return NAV_BACKWARDS;
    }
    return ((queue->waits & bits_of(sensor)) != 0U) ? NAV_QUEUE_FULL : NAV_TAKEN;
}

void nav_jobs_put(nav_t *nav, nav_sensor_t sensor, uint32_t t_us, const nav_real_t *values)
{
    nav_queue_t *queue = &nav->queue;
    uint8_t first = first_of(sensor);
    uint8_t count = (sensor == NAV_GPS) ? DOWN : (uint8_t)((sensor == NAV_DOWN) ? 1 : 3);
    for (uint8_t i = 0; i < count; i++) {
        queue->value[first + i] = values[i];
    }
    queue->t_us[sensor] = t_us;
    queue->waits |= bits_of(sensor);
    queue->arrived |= (uint8_t)bit(sensor);
    queue->seen |= (uint8_t)bit(sensor);
}

/* A fixed direction, from which the body has rotated since then: m + m x (w age). */
static void take_field(nav_t *nav)
{
    nav_queue_t *queue = &nav->queue;
    nav_real_t came[3];
    nav_real_t turned[3];
    nav_real_t age = nav_seconds(queue->t_us[NAV_FIELD], nav->t_us);
    nav_real_t angle[3];
    for (uint8_t i = 0; i < 3U; i++) {
        came[i] = queue->value[FIELD + i];
        turned[i] = came[i];
        angle[i] = age * (nav->rate_rps[i] - nav->state.gyro_drift_rps[i]);
    }
    nav_add_cross(turned, came, angle);
    nav_real_t dcm[9];
    nav_ins_dcm(dcm, nav->state.quaternion);
    nav_align_innovation(queue->value + FIELD, nav->tau, dcm, turned);
}

/* Measured less computed, at the epoch. */
static void take_motion(nav_t *nav, uint8_t sensor)
{
    nav_queue_t *queue = &nav->queue;
    nav_real_t motion[6];
    nav_past_at(&nav->past, motion, queue->t_us[sensor], &nav->state, nav->t_us);
    if (sensor == NAV_DOWN) {
        queue->value[DOWN] -= motion[POSITION + 2];
        return;
    }
    for (uint8_t i = 0; i < DOWN; i++) {
        queue->value[i] -= motion[i];
    }
}

/* Turns arrived measurements that are not ahead of the state into innovations; false: there were none. */
static bool take_in(nav_t *nav)
{
    bool taken = false;
    for (uint8_t sensor = NAV_GPS; sensor <= NAV_FIELD; sensor++) {
        bool here = (nav->queue.arrived & bit(sensor)) != 0U;
        if (!here || nav_time_from(nav->queue.t_us[sensor], nav->t_us) < 0) {
            continue;
        }
        nav->queue.arrived &= (uint8_t)~bit(sensor);
        taken = true;
        if (sensor == NAV_FIELD) {
            take_field(nav);
        } else {
            take_motion(nav, sensor);
        }
    }
    return taken;
}

/* dv(e) = dv - age f x mu; dr(e) = dr - age dv. */
static void motion_row(nav_ud_scalar_t *row, uint8_t scalar, const nav_real_t force[3], nav_real_t age)
{
    uint8_t k = (scalar == DOWN) ? 2 : (uint8_t)(scalar % 3U);
    if (scalar >= POSITION) {
        row->first = (uint8_t)(NAV_R0 + k);
        row->end = (uint8_t)(k + (uint8_t)(NAV_V0 + 1));
        row->f[NAV_V0 + k] = -age;
    } else {
        nav_real_t unit[3] = { 0, 0, 0 };
        unit[k] = age;
        row->first = (uint8_t)(NAV_V0 + k);
        row->end = NAV_C0;
        nav_add_cross(row->f + NAV_M0, force, unit); /* e_k . (f x mu) = -(f x e_k) . mu */
    }
    row->f[row->first] = 1;
}

/* The current row of a scalar. */
static void row_of(nav_ud_scalar_t *row, const nav_t *nav, uint8_t scalar)
{
    for (uint8_t i = 0; i < NAV_STATES; i++) {
        row->f[i] = 0;
    }
    if (scalar < FIELD) {
        motion_row(row, scalar, nav->force_ned_mps2, nav_seconds(nav->queue.t_us[sensor_of(scalar)], nav->t_us));
        return;
    }
    row->first = NAV_M0;
    row->end = NAV_C0;
    nav_add_scaled(row->f + NAV_M0, 1, nav->tau[scalar - FIELD]);
}

static nav_real_t variance_of(const nav_t *nav, uint8_t scalar)
{
    return nav->variance[(scalar < DOWN) ? 1U + scalar / 3U : ((scalar == DOWN) ? 3U : 0U)];
}

/* Scalars whose epoch has been taken in. */
static uint16_t ready(const nav_queue_t *queue)
{
    uint16_t scalars = queue->waits;
    for (uint8_t sensor = NAV_GPS; sensor <= NAV_FIELD; sensor++) {
        if ((queue->arrived & bit(sensor)) != 0U) {
            scalars &= (uint16_t)~bits_of(sensor);
        }
    }
    return scalars;
}

/*
 * Refused: the innovation's square is beyond the gate. After five such epochs the covariance is considered wrong. The
 * innovation is most likely when its variance equals its square, so that much is added where the scalar measures. It
 * then passes any gate of 1 or more, and gets nearly the full gain. A field does not observe the rotation about itself,
 * so its addition goes along P h', to the least known angles: to the heading, if GPS keeps the others.
 */
static bool refuse(nav_t *nav, uint8_t scalar, nav_ud_scalar_t *update, nav_real_t square)
{
    nav_queue_t *queue = &nav->queue;
    if (nav->counts.answer[NAV_GATED] < UINT16_MAX) {
        nav->counts.answer[NAV_GATED]++;
    }
    queue->refused[scalar]++;
    if (queue->refused[scalar] < NAV_REFUSALS) {
        return false;
    }
    queue->refused[scalar] = 0;
    nav_real_t known = update->variance - variance_of(nav, scalar); /* h P h' */
    if (scalar < FIELD) {
        nav_ud_noise(nav->ud, update->first, square);
    } else if (known > 0) {
        nav_ud_reach(update, nav->ud, NAV_M0, NAV_C0);
        nav_ud_spread(nav->ud, update->f, NAV_C0 - 1, square / (known * known));
    }
    return true;
}

/* Closed loop, with x in place of the gain: corrects the state and the waiting innovations. */
static void correct(nav_t *nav, nav_ud_scalar_t *update)
{
    uint16_t scalars = ready(&nav->queue);
    nav_ins_correct(&nav->state, update->gain);
    nav_past_correct(&nav->past, update->gain);
    for (uint8_t i = 0; i < NAV_SCALARS; i++) {
        if ((scalars & bit(i)) != 0U) {
            row_of(update, nav, i);
            nav->queue.value[i] -= nav_ud_times(update);
        }
    }
}

static void use_scalar(nav_t *nav, uint8_t scalar)
{
    nav_queue_t *queue = &nav->queue;
    nav_real_t innovation = queue->value[scalar];
    nav_real_t square = innovation * innovation;
    nav_ud_scalar_t update;
    row_of(&update, nav, scalar);
    nav_ud_look(&update, nav->ud, variance_of(nav, scalar));
    bool beyond = nav->gate_squared > 0 && square > nav->gate_squared * update.variance;
    if (beyond && refuse(nav, scalar, &update, square)) {
        return; /* it stays queued, and passes next time */
    }
    queue->waits &= (uint16_t)~bit(scalar);
    if (beyond) {
        return;
    }
    queue->refused[scalar] = 0;
    nav_ud_update(nav->ud, &update, variance_of(nav, scalar));
    for (uint8_t i = 0; i < NAV_STATES; i++) {
        update.gain[i] *= innovation;
    }
    correct(nav, &update);
}

/* The last sensor first: the field arrives most often, and must be used before its next epoch. */
static bool use_one(nav_t *nav)
{
    uint16_t scalars = ready(&nav->queue);
    for (uint8_t i = NAV_SCALARS; i-- > 0U;) {
        if ((scalars & bit(i)) != 0U) {
            use_scalar(nav, i);
            return true;
        }
    }
    return false;
}

void nav_jobs_run(nav_t *nav)
{
    bool noise_first = nav->noise.owed != 0U || nav->queue.in_a_row >= ROW_AGAIN;
    if (take_in(nav) || (!noise_first && use_one(nav))) {
        if (nav->queue.in_a_row < UINT8_MAX) {
            nav->queue.in_a_row++;
        }
        return;
    }
    nav->queue.in_a_row = 0;
    if (nav->noise.next == 0U) { /* once a round: steps of 0.2 rad shorten it by 8e-6 */
        nav_ins_unit(nav->state.quaternion);
    }
    nav_noise_job(&nav->noise, nav->ud, nav->t_us);
}
