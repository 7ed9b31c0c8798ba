/*
 * The parameters of the filter in force: the shipped values of the output data rate, but for those that the user has
 * set (settings.own). Values as stored (filter.h). Main only.
 */
#ifndef PARAMETERS_H
#define PARAMETERS_H

#include <stdbool.h>
#include <stdint.h>

#include "filter_list.h"

/* One of them, as in force at the nominal rate. */
uint32_t parameters_value(uint8_t which);

/* The filter takes those that the user has set, with the others as shipped. */
bool parameters_legal(void);

/* Begins a filter of this kind with them, legal ones, at the output data rate that the sensor has, 0.1 Hz. */
void parameters_start(filter_t *f, filter_kind_t kind, uint16_t rate_dhz);

/* The measurement variance R that the user has set, LSB^2 Q8; 0: none, the estimated one counts. */
uint32_t parameters_r_lsb2_q8(void);

#endif
