/*
 * Shapes of paper 000's turns for C and C++: s from 0 to 1 over the turn, the angle in shares of its amplitude.
 */
#ifndef SUPPORT_ROLL_SHAPES_H
#define SUPPORT_ROLL_SHAPES_H

#include <math.h>

#define ROLL_PI 3.14159265358979323846

static inline double roll_ramp(double s)
{
    return s;
}

static inline double roll_cosine(double s)
{
    return 0.5 - 0.5 * cos(ROLL_PI * s);
}

static inline double roll_bump(double s)
{
    return 0.5 - 0.5 * cos(2.0 * ROLL_PI * s);
}

static inline double roll_sine(double s)
{
    return sin(2.0 * ROLL_PI * s);
}

#endif
