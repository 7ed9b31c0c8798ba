// Paper 002, Table 1: an aircraft's elevation angle seen by a landing system whose readings are outliers now and then.
#ifndef PAPERS_MODEL_H
#define PAPERS_MODEL_H

#include <cstdint>
#include <vector>

extern "C" {
#include "support/random.h"
}

namespace papers
{
constexpr double period_s = 0.0247;
constexpr double q_rate =
    0.0009; // (degree/s)^2 per sample, on the rate: the reading that fits the paper's linear filter
constexpr double clean = 0.85;
constexpr double ratio = 20.0;
constexpr double sigma_deg = 0.08;
constexpr double lsb_deg = 0.02;

struct Scenario {
    double outliers = 1.0 - clean; // their probability
    double stay = 0.0;             // (11): that an outlier follows an outlier; 0: they are independent
    bool first_clean = false;      // the first sample is none
    int step_at = -1;              // from this sample on the angle is off by step_sigma
    double step_sigma = 0.0;
    int burst_at = -1; // so many samples in a row are outliers
    int burst_length = 0;
};

struct Sample {
    double truth;
    double y;
    bool outlier;
};

// One realisation, made sample by sample: the same for every filter that looks at it.
class Realisation
{
  public:
    Realisation(const Scenario &scenario, std::uint64_t seed);
    const Sample &at(int k);

  private:
    void extend();
    double chance_of_outlier() const;

    Scenario scenario_;
    test_random_t random_;
    double angle_ = 3.2; // s(0)
    double rate_ = 0.01;
    std::vector<Sample> samples_;
};

// A seed for each run of an experiment.
std::uint64_t run_seed(std::uint64_t seed, std::uint64_t run);
} // namespace papers

#endif
