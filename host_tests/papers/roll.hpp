// Paper 000's experiment: 15 s of a UAV's roll at 10 Hz, at rest for 5 s, turning from 6 to 10 s, at rest again, seen
// with noise of variance R. Mean square errors over the paper's intervals: exactly, and by Monte Carlo.
#ifndef PAPERS_ROLL_H
#define PAPERS_ROLL_H

#include "estimators.hpp"
#include "report.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace papers::roll
{
constexpr int samples = 151;
constexpr double period_s = 0.1;
constexpr double r_deg2 = 0.6;  // near the paper's Table 1, which gives none
constexpr double p0_deg2 = 5.0; // the paper's P(0)
constexpr double begin_s = 6.0; // the turn
constexpr double turn_s = 4.0;

// Samples first..last, both counted.
struct Window {
    const char *name;
    int first;
    int last;
};
enum WindowAt { at_start, at_rest, turning, settled, window_count };
constexpr std::array<Window, window_count> windows{
    { { "0_5", 0, 50 }, { "2_5", 20, 50 }, { "6_10", 60, 100 }, { "11_15", 110, 150 } }
};
using PerWindow = std::array<double, window_count>;

struct Profile {
    const char *name;
    double amplitude_deg;
    double (*shape)(double s); // of the turn's part s, 0..1; 0 before, shape(1) after
    double truth_deg(int k) const;
};

// ramp30, cos60, minjerk60, bump30, sine30, triangle30, steps30: all seven. bump, sine and triangle return.
const std::array<Profile, 7> &profiles();
const Profile &profile(const std::string &name);

// --- exact: for estimators that are linear in their samples (their gains may depend on time, not on data)

// What white noise of variance 1 becomes, sample by sample; the noise of sample j stands alone for each j.
struct NoiseGain {
    std::vector<double> estimate; // variance of x^
    std::vector<double> residual; // variance of g - x^
};
NoiseGain noise_gain(const Maker &maker, int count);

// Estimate less truth when there is no noise.
std::vector<double> bias_deg(const Maker &maker, const std::vector<double> &truth_deg);

PerWindow mean_over_windows(const std::vector<double> &values);

struct Exact {
    PerWindow mse_deg2;   // bias^2 + variance
    PerWindow bias2_deg2; // bias^2 alone
    double peak_deg;      // largest |bias|
};
Exact exact(const Maker &maker, const Profile &profile, double r = r_deg2);

// --- Monte Carlo: for any estimator

struct Noise {
    double r = r_deg2;
    double outliers = 0.0;    // their probability
    double ratio = 20.0;      // an outlier's noise is so many times the usual
    double shift_sigma = 0.0; // not 0: an outlier is the usual noise and +-shift_sigma standard deviations instead
};

// One realisation: the same for a seed and a run, whatever looks at it.
std::vector<double> measured_deg(const Profile &profile, const Noise &noise, std::uint64_t seed, int run);

struct Score {
    std::array<Interval, window_count> mse_deg2; // mean over the runs, 95 %
    PerWindow one_run_sd_deg2;                   // standard deviation of a single run's
};
std::vector<Score> monte_carlo(const std::vector<Maker> &makers, const Profile &profile, const Noise &noise, int runs,
                               std::uint64_t seed);
} // namespace papers::roll

#endif
