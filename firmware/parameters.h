/*
 * Settings that are numbers with a descriptor (filter_parameter_t): first the vectors of the calibration, three numbers
 * each, then the parameters of the filter in force. These have the shipped values of the output data rate, but for
 * those that the user has set (settings.own). Values as stored (filter.h). Main only.
 */
#ifndef PARAMETERS_H
#define PARAMETERS_H

#include <stdbool.h>
#include <stdint.h>

#include "filter_list.h"

enum { PARAMETERS_NONE = 0xFF, PARAMETERS_AXES = 3 };

/* How many there are, with the filter in force. */
uint8_t parameters_count(void);

/* Which of them has this name (RAM); PARAMETERS_NONE when none has. */
uint8_t parameters_find(const char *name);

/* Descriptor of one of them, in program memory. */
const filter_parameter_t *parameters_at(uint8_t which);

/* Numbers that it has: PARAMETERS_AXES or 1. */
uint8_t parameters_numbers(uint8_t which);

/* One of its numbers, as in force at the nominal rate. */
uint32_t parameters_value(uint8_t which, uint8_t number);

/*
 * Sets all its numbers; false, and nothing changes: out of range, or not what calibration or filter take with the
 * others. The pipeline has a calibration at once, a filter's parameter with parameters_start.
 */
bool parameters_set(uint8_t which, const uint32_t values[PARAMETERS_AXES]);

/* Begins a filter of this kind with them, legal ones, at the output data rate that the sensor has, 0.1 Hz. */
void parameters_start(filter_t *f, filter_kind_t kind, uint16_t rate_dhz);

/* The measurement variance R that the user has set, LSB^2 Q8; 0: none, the estimated one counts. */
uint32_t parameters_r_lsb2_q8(void);

#endif
