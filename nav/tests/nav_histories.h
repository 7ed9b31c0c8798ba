/* Sigmas of paper 003: covariance along the flight of 3.4, linearised about the truth, by references and nav/lib. */
#ifndef NAV_HISTORIES_H
#define NAV_HISTORIES_H

#include "nav_flights.h"

typedef struct {
    double sigma[FLIGHT_SECONDS]
                [12]; /* [i]: behind the measurements at i + 1 s; m, m/s, rad, rad/s in nav/lib's order */
    double least_d;   /* of nav/lib */
} nav_history_t;

/* form, printed: as in reference_nav.h. Printed q; field, GPS and altimeter at 1 Hz, GPS not in 160..400 s. */
void nav_history_of_reference(nav_history_t *history, int form, int states, int printed);

/* The same by nav/lib. turns: noise as nav/lib adds it, one state per step; else of all at every step. */
void nav_history_of_ours(nav_history_t *history, const nav_variant_t *variant, bool turns);

/* Largest difference of a sigma, relative to b. */
double nav_histories_apart(const nav_history_t *a, const nav_history_t *b, int states);

#endif
