#include "model.hpp"

#include <cmath>

namespace papers
{
std::uint64_t run_seed(std::uint64_t seed, std::uint64_t run)
{
    // splitmix64: neighbouring runs start far from each other
    std::uint64_t z = seed * 0x9E3779B97F4A7C15U + run * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
}

Realisation::Realisation(const Scenario &scenario, std::uint64_t seed) : scenario_(scenario)
{
    random_seed(&random_, seed);
    samples_.reserve(400);
}

void Realisation::extend()
{
    const int k = static_cast<int>(samples_.size());
    angle_ += period_s * rate_; // (5)
    rate_ += std::sqrt(q_rate) * random_normal(&random_);
    const double v = sigma_deg * random_normal(&random_);
    bool outlier = random_uniform(&random_) < chance_of_outlier() && !(k == 0 && scenario_.first_clean);
    outlier = outlier ||
              (scenario_.burst_at >= 0 && k >= scenario_.burst_at && k < scenario_.burst_at + scenario_.burst_length);
    const bool stepped = scenario_.step_at >= 0 && k >= scenario_.step_at;
    const double truth = angle_ + (stepped ? scenario_.step_sigma * sigma_deg : 0.0);
    samples_.push_back({ truth, truth + (outlier ? ratio : 1.0) * v, outlier }); // (4)
}

double Realisation::chance_of_outlier() const
{
    if (scenario_.stay == 0.0 || samples_.empty()) {
        return scenario_.outliers;
    }
    return samples_.back().outlier ? scenario_.stay
                                   : scenario_.outliers * (1.0 - scenario_.stay) / (1.0 - scenario_.outliers);
}

const Sample &Realisation::at(int k)
{
    while (static_cast<int>(samples_.size()) <= k) {
        extend();
    }
    return samples_[static_cast<std::size_t>(k)];
}
} // namespace papers
