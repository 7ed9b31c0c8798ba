/* What waits, and the one job of a slot. */
#ifndef NAV_JOBS_H
#define NAV_JOBS_H

#include "nav.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum { NAV_GPS, NAV_DOWN, NAV_FIELD } nav_sensor_t;

/* Whether an epoch of this sensor may come now: NAV_TAKEN, or why not. */
nav_answer_t nav_jobs_may(const nav_t *nav, nav_sensor_t sensor, uint32_t t_us);

/* Puts its values down (6, 1 or 3). */
void nav_jobs_put(nav_t *nav, nav_sensor_t sensor, uint32_t t_us, const nav_real_t *values);

/* Nothing waits, no epoch was seen. */
void nav_jobs_forget(nav_queue_t *queue);

/*
 * One job: epochs that have arrived are taken in; or one scalar that waits is used; or noise is added. After three
 * others in a row it is noise, so that no rate of measurements keeps the covariance from growing.
 */
void nav_jobs_run(nav_t *nav);

#ifdef __cplusplus
}
#endif
#endif
