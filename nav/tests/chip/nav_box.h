/* What the program on the chip and the one on the PC share: laid out alike on both, because all is of four bytes. */
#ifndef NAV_BOX_H
#define NAV_BOX_H

#include "nav.h"

typedef struct {
    float rate[3], force[3], velocity[3], position[3], down, field[3];
    uint32_t t_us;
    uint8_t calls; /* a bit per call */
} nav_box_t;

enum { NAV_CALL_INIT = 1, NAV_CALL_IMU, NAV_CALL_GPS, NAV_CALL_DOWN, NAV_CALL_FIELD, NAV_CALLS };
enum { NAV_ASKS_CONFIG = 1, NAV_ASKS_RECORD, NAV_TELLS_STATE, NAV_REFUSES };

#endif
