/* See gravity.h. */
#include "path/gravity.h"

/* 0.612 g = 156.8 LSB, and below 1.392 g = 356.3 LSB. */
enum { LEAST = 6, BEYOND = 31 };
enum { ABSENT_S = 10 };

static uint8_t absent_s; /* seconds without gravity in a row, up to ABSENT_S */

void gravity_forget(void)
{
    absent_s = 0;
}

void gravity_second(bool still, uint16_t square)
{
    bool within = (uint16_t)(square - LEAST) < BEYOND - LEAST;
    if (absent_s == ABSENT_S) {
        if (still && within) {
            absent_s = 0;
        }
        return;
    }
    absent_s++;
    if (!still || within) {
        absent_s = 0;
    }
}

bool gravity_absent(void)
{
    return absent_s == ABSENT_S;
}
