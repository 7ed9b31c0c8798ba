// Paper 001's experiment: 70 s of a UAV's altitude at 10 Hz, straight to 20 s, accelerated by 5 m/s^2 to 35 s and by
// -5 m/s^2 to 50 s, straight again, seen with noise of 0.5 m.
#ifndef PAPERS_ALTITUDE_H
#define PAPERS_ALTITUDE_H

#include "estimators.hpp"
#include "report.hpp"

#include <cstdint>
#include <vector>

namespace papers::altitude
{
constexpr int samples = 701;
constexpr double period_s = 0.1;
constexpr double sigma_m = 0.5;
constexpr double acceleration_m_s2 = 5.0;

// The paper's "polynomial of second order" is x = a t^2 / 2 or, to the letter of a polynomial, x = a t^2.
enum class Reading { half_a_t2, a_t2 };

// Altitude above the straight line on which it begins: every filter here follows a line without error, so a line more
// or less changes nothing, and without it the start is exact when the past estimates are 0.
double truth_m(Reading reading, int k);

// Second difference of the altitude while it is accelerated upwards.
double second_difference_m(Reading reading);

struct Result {
    Interval sigma;            // root mean square error over both straight legs, 0-20 and 50-70 s
    double sigma_one_run;      // standard deviation of a single run's
    Interval sigma_stationary; // over 10-20 s
    Interval lag_up;           // mean error (altitude less estimate) over 20-35 s
    Interval lag_down;         // over 35-50 s
    Interval lag_settled;      // over 30-35 s
};

// The same without chance, for a filter that is linear in its samples: r is the variance of their noise.
struct Exact {
    double sigma;
    double sigma_stationary;
    double lag_up;
    double lag_down;
    double lag_settled;
};
Exact exact(const Maker &maker, Reading reading, int run_in, double r);

// run_in: so many samples of the first leg before 0 s, for filters that cannot begin exactly.
Result monte_carlo(const Maker &maker, Reading reading, int run_in, int runs, std::uint64_t seed);
} // namespace papers::altitude

#endif
