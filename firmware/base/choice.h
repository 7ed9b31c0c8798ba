/*
 * The filter that the user has chosen: the shipped parameters for the output data rate, except those the user has set.
 * Values as stored (filter.h). Pure; main only.
 */
#ifndef CHOICE_H
#define CHOICE_H

#include <stdbool.h>
#include <stdint.h>

#include "filter_list.h"

enum { CHOICE_PARAMETERS_MAX = 8 };

typedef struct {
    uint32_t parameters[CHOICE_PARAMETERS_MAX]; /* valid where `own` has a bit */
    uint8_t own;                                /* bits: which parameters the user has set */
    uint8_t filter;                             /* filter_kind_t: differs from image to image */
    uint8_t mark;   /* the same in all images: the byte that identifies a filter of filter_list.h */
    uint8_t unused; /* leaves no padding on the PC: the bytes are saved as they are in memory */
} filter_choice_t;

/* The chosen law. */
const filter_law_t *choice_law(const filter_choice_t *choice);

/* One of its parameters, as in force at a nominal rate, 0.1 Hz. */
uint32_t choice_value(const filter_choice_t *choice, uint16_t rate_dhz, uint8_t which);

/* The filter accepts the user's parameters, with the others as shipped. */
bool choice_legal(const filter_choice_t *choice, uint16_t rate_dhz);

/*
 * Initialises a filter of this kind for the sensor's output data rate, 0.1 Hz: with the user's parameters if it is the
 * chosen one and accepts them at this rate, else as shipped.
 */
void choice_begin(const filter_choice_t *choice, filter_t *f, filter_kind_t kind, uint16_t rate_dhz);

/* The measurement variance R set by the user, LSB^2 Q8; 0: none, the estimate applies. */
uint32_t choice_r_lsb2_q8(const filter_choice_t *choice);

#endif
