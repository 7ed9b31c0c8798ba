/* Flights of paper 003 through a variant of nav/lib: by its queue, or all scalars of an epoch at once. */
#ifndef NAV_FLIGHTS_H
#define NAV_FLIGHTS_H

#include "nav_variants.h"
#include "support/flight.h"

enum { FLIGHT_SECONDS = 500, FLIGHT_RATE = 100 };

typedef struct {
    const nav_variant_t *variant;
    const flight_drift_t *drift;
    double walk_scale; /* on the printed q */
    int field_every;   /* IMU periods */
    bool at_once;      /* without queue: noise of all states at every step, all scalars of an epoch in one slot */
    double gate;
    uint32_t seed;
    uint32_t start_us; /* time of the start */
    int note_at; /* slot of each second, 0..99, behind which errors and variances are noted; 99: at the full second */
    int seconds; /* up to FLIGHT_SECONDS */
} nav_plan_t;

/* True less computed, once a second. */
typedef struct {
    double euler[3]; /* rad: roll, pitch, heading */
    double velocity[3], position[3], drift[3];
    double variance[12];
} nav_second_t;

typedef struct {
    nav_second_t second[FLIGHT_SECONDS]; /* [i]: of the second that ends at i + 1 s */
    double least_d;
    int deepest_queue;
    unsigned count[ANSWERS];
} nav_flight_t;

/* The paper's start, its noises and its q, times the scale. */
void nav_flight_setting(nav_setting_t *setting, double walk_scale);

/* GPS is there at this time, s: not in 160..400. */
bool nav_flight_has_gps(double t);

void nav_fly(nav_flight_t *flight, const nav_plan_t *plan);

/* Largest |.| over the seconds after `from` up to and with `to`. */
double nav_worst_euler(const nav_flight_t *flight, int axis, int from, int to);
double nav_worst_position(const nav_flight_t *flight, int from, int to);

double nav_median(double *values, int count);

#endif
