/* A variant of nav/lib that is fed record by record, at rest at the origin. */
#ifndef NAV_RUNNING_H
#define NAV_RUNNING_H

#include "nav_flights.h"

typedef struct {
    const nav_variant_t *v;
    nav_memory_t m;
    nav_setting_t setting;
    uint32_t t_us;
} running_t;

extern const double still_rate[3], still_force[3], still_nowhere[3];

/* What a body at rest is begun with. */
void still_setting(nav_setting_t *s);

/* The filter behind nav_init with it, its clock at t_us. */
void still_begin(running_t *r, const nav_variant_t *v, uint32_t t_us);

/* The IMU's next record, 10 ms on; its answer. */
int still_record(running_t *r);

/* At rest with all sensors for some seconds. */
void still_seconds(running_t *r, int seconds);

/* Within 5 sigma of what a still body at the origin is, and healthy. */
void still_is_seen(const running_t *r);

#endif
