/*
 * Included before anything else when two builds are compared state by state: on the PC the states then lie as on the
 * AVR, without gaps, so that a byte's offset means the same in both.
 */
#ifndef PACKED_STATES_H
#define PACKED_STATES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#pragma pack(push, 1)
#include "filter_list.h"
#include "noise.h"
#include "tilt.h"
#pragma pack(pop)

#endif
