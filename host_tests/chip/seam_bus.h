/* State of the handler that the seam check compiles twice. */
#ifndef SEAM_BUS_H
#define SEAM_BUS_H

#include <stdint.h>

extern volatile uint8_t seam_state, seam_index, seam_length, seam_address;
extern uint8_t seam_buffer[8];

#endif
