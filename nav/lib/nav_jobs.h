/* Waiting measurements, and the one job of a slot. */
#ifndef NAV_JOBS_H
#define NAV_JOBS_H

#include "nav.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum { NAV_GPS, NAV_DOWN, NAV_FIELD } nav_sensor_t;

/* Whether an epoch of this sensor is accepted at this time: NAV_TAKEN, or the reason. */
nav_answer_t nav_jobs_may(const nav_t *nav, nav_sensor_t sensor, uint32_t t_us);

/* Stores its values (6, 1 or 3). */
void nav_jobs_put(nav_t *nav, nav_sensor_t sensor, uint32_t t_us, const nav_real_t *values);

/* Empties the queue, epochs seen included. */
void nav_jobs_forget(nav_queue_t *queue);

/*
 * One job: arrived epochs are taken in, or one waiting scalar is used, or noise is added. After three others in a row
 * it is noise, so that the covariance can grow at any rate of measurements.
 */
void nav_jobs_run(nav_t *nav);

#ifdef __cplusplus
}
#endif
#endif
