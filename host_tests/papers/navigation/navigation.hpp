// Paper 003: the experiments of its INS/GNSS filter, by the references in Eigen and by nav/lib in double and float.
#ifndef PAPERS_NAVIGATION_H
#define PAPERS_NAVIGATION_H

#include "../report.hpp"

extern "C" {
#include "nav_histories.h"
}

namespace papers::navigation
{
// The arithmetic that a variant of nav/lib calculates in.
inline Arithmetic arithmetic_of(const nav_variant_t &variant)
{
    return variant.in_double ? Arithmetic::in_double : Arithmetic::in_float;
}

// Dip, declination, tau (3.34) of the Earth's field in nT.
void tau(const Options &options);

// Sigmas without closed loop at 160, 399 and 500 s of the flight of 3.4, by five forms.
void covariance(const Options &options);

// Errors in closed loop, a flight for each 50 runs and 200 at most, without GPS in 160..400 s: nav/lib in float with
// its queue, the field at 1 and 10 Hz; and in double without queue, the field at 100 Hz.
void closed_loop(const Options &options);
void closed_loop_100_hz(const Options &options);

// One case of it, five times as many flights.
void closed_loop_100_hz_25_q(const Options &options);
} // namespace papers::navigation

#endif
