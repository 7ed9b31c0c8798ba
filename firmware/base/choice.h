/*
 * The filter that the user has chosen: the shipped parameters of the output data rate, but for those that he has set.
 * Values as stored (filter.h). Pure; main only.
 */
#ifndef CHOICE_H
#define CHOICE_H

#include <stdbool.h>
#include <stdint.h>

#include "filter_list.h"

enum { CHOICE_PARAMETERS_MAX = 8 };

typedef struct {
    uint32_t parameters[CHOICE_PARAMETERS_MAX]; /* those of which `own` has a bit */
    uint8_t own;                                /* bits: which parameters the user has set */
    uint8_t filter;                             /* filter_kind_t: another number in each image */
    uint8_t mark;   /* the same for all images: the byte by which a filter of filter_list.h is known */
    uint8_t unused; /* so that there is no gap on the PC: the bytes are saved as they lie */
} filter_choice_t;

/* The law that is chosen. */
const filter_law_t *choice_law(const filter_choice_t *choice);

/* One of its parameters, as in force at a nominal rate, 0.1 Hz. */
uint32_t choice_value(const filter_choice_t *choice, uint16_t rate_dhz, uint8_t which);

/* It takes those that the user has set, with the others as shipped. */
bool choice_legal(const filter_choice_t *choice, uint16_t rate_dhz);

/*
 * Begins a filter of this kind at the output data rate that the sensor has, 0.1 Hz: with the user's parameters if it is
 * the one that he has chosen and takes them at this rate; else as shipped.
 */
void choice_begin(const filter_choice_t *choice, filter_t *f, filter_kind_t kind, uint16_t rate_dhz);

/* The measurement variance R that the user has set, LSB^2 Q8; 0: none, the estimated one counts. */
uint32_t choice_r_lsb2_q8(const filter_choice_t *choice);

#endif
