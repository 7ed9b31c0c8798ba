/*
 * Records between a PC and the navigation filter, over frames (nav_frame.h). Each record from the PC gets one reply, in
 * order, that says how many bytes have been received: the PC keeps no more than LINK_WINDOW in flight, so that nothing
 * is lost at any baud rate. docs/navigation-link.md has the tables. Numbers are little-endian, reals IEEE
 * 754 single precision.
 */
#ifndef NAV_LINK_H
#define NAV_LINK_H

#include <stdbool.h>
#include <stdint.h>

#include "hal_uart.h"
#include "nav.h"

#define LINK_VERSION 1u
#define LINK_WINDOW (HAL_UART_RX_SIZE - 1u) /* bytes that fit the receive ring */

/* From the PC: type, sequence number, then */
enum {
    RECORD_PARAMETERS = 'P', /* u8 of the first, 6 reals: nav_config_t's 30 in its order, from 0, 6, 12, 18 or 24 on.
                                Ends a flight that is under way */
    RECORD_START = 'S',      /* u32 period_us: starts, with the 30 reals received since the last start */
    RECORD_IMU = 'I',        /* u32 t_us, 3 reals rad/s, 3 reals m/s2, u8 1: send the state after it */
    RECORD_GPS = 'G',        /* u32 t_us of its epoch, 3 reals m/s, 3 reals m */
    RECORD_DOWN = 'A',       /* u32 t_us, real m: altimeter */
    RECORD_FIELD = 'M',      /* u32 t_us, 3 reals: magnetometer, any unit */
    RECORD_VARIANCES = 'V',  /* requests them */
    RECORD_COUNTS = 'C',     /* requests them */
    RECORD_HELLO = 'H'       /* requests the greeting; the next record may have any number */
};

/* To the PC */
enum {
    ANSWER_HELLO = 'h',     /* u8 version, u8 states, u16 window, u8 reset cause */
    ANSWER_RECORD = 'k',    /* u8 sequence, u8 type, u8 answer, u8 waiting updates, u16 bytes taken since the start */
    ANSWER_STATE = 's',     /* u32 t_us, 13 reals: quaternion, velocity, position, drift */
    ANSWER_VARIANCES = 'v', /* u8 1: healthy (nav_healthy), NAV_STATES reals: r, v, mu, drift */
    ANSWER_COUNTS = 'c'     /* u16 for each nav_answer_t, then for each link_answer_t, then records missing */
};

/* Why the link did not pass a record to the filter; the filter's own answers (nav_answer_t) are below 32. */
typedef enum {
    LINK_BROKEN = 32,   /* CRC or stuffing: the record is unknown, so type and sequence are 0 */
    LINK_UNKNOWN,       /* no such type */
    LINK_LENGTH,        /* wrong length for its type */
    LINK_ORDER,         /* a number already received */
    LINK_NOT_STARTED,   /* no start yet */
    LINK_START_REFUSED, /* a parameter is missing, outside its range or not finite */
    LINK_ANSWERS_END
} link_answer_t;

/* Sets up the line at LINK_BAUD and sends the greeting. Main, once. */
void link_start(void);

/* Processes received bytes, at most one record, and replies. False: there was nothing to do. Main. */
bool link_pass(void);

#define LINK_BAUD 1000000ul

#endif
