/*
 * The number type of nav/lib: float, or double if NAV_DOUBLE is defined (the same code as its own reference).
 *
 * Identical bits on every machine require constants of that type (NAV_R), no fused multiply-add (-ffp-contract=off),
 * and only + - * / and the square root, which IEEE 754 rounds one way.
 */
#ifndef NAV_REAL_H
#define NAV_REAL_H

#ifdef NAV_DOUBLE
typedef double nav_real_t;
#define NAV_R(number) number
#else
typedef float nav_real_t;
#define NAV_R(number) number##f
#endif

#endif
