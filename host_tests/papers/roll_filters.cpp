// Every filter of FILTER_LIST as shipped, and some of stated tuning, on all seven rolls.
#include "experiments_000.hpp"
#include "linear.hpp"
#include "roll.hpp"
#include "twins.hpp"

#include <cmath>

namespace papers::roll
{
namespace
{
// 256 LSB/g near level: a degree is 256 pi / 180 LSB, and R = 0.6 degree^2 is 12 LSB^2.
const double lsb_per_degree = 256.0 * std::acos(-1.0) / 180.0;

struct Entry {
    std::string title;
    Arithmetic arithmetic;
    Maker maker;
    std::optional<Maker> linear; // what its exact error is that of
    double r;                    // variance of what that is given
};

Entry in_double(const std::string &title, const Maker &maker)
{
    return { title, Arithmetic::in_double, maker, maker, r_deg2 };
}

Entry as_shipped(const std::string &title, const std::string &name,
                 const std::map<std::string, double> &parameters = {})
{
    Shipping shipping;
    shipping.lsb_per_unit = lsb_per_degree;
    shipping.parameters = parameters;
    return { title, Arithmetic::fixed, shipped(name, shipping), linear_twin(name, shipping),
             rounded_variance(r_deg2, shipping) };
}

// kf with process noise lambda R on the rate per sample: q T^3 = lambda R, in LSB
Entry tuned_kf(const std::string &title, double lambda)
{
    const double q = lambda * r_deg2 * lsb_per_degree * lsb_per_degree / (period_s * period_s * period_s);
    return as_shipped(title, "kf", { { "q", q } });
}

std::vector<Entry> entries()
{
    std::vector<Entry> result = { in_double("kf2_rate(0.01)", steady_kalman(white_rate(0.01))),
                                  in_double("kf2_rate(0.1)", steady_kalman(white_rate(0.1))),
                                  in_double("synth(-0.3:0.1)", synthesised(-0.3, 0.1)),
                                  in_double("synth(0:0.3)", synthesised(0.0, 0.3)),
                                  as_shipped("synth(-0.3:0.1)", "synth", { { "a1", -0.3 }, { "b0", 0.1 } }),
                                  tuned_kf("kf(0.01)", 0.01),
                                  tuned_kf("kf(0.1)", 0.1) };
    for (const std::string &name : shipped_names()) {
        result.push_back(as_shipped(name, name));
    }
    return result;
}

void exact_rows(const Entry &entry, const Profile &turn)
{
    if (!entry.linear) {
        return;
    }
    const Exact value = exact(*entry.linear, turn, entry.r);
    for (std::size_t w = 0; w < window_count; w++) {
        row(std::string("filters_") + turn.name, entry.title, entry.arithmetic,
            std::string("exact_mse_") + windows[w].name, value.mse_deg2[w], 1);
    }
}
} // namespace

void all_filters(const Options &options)
{
    const std::vector<Entry> all = entries();
    std::vector<Maker> makers;
    for (const Entry &entry : all) {
        makers.push_back(entry.maker);
    }
    Progress progress(static_cast<double>(profiles().size()));
    for (const Profile &turn : profiles()) {
        const std::vector<Score> scores = monte_carlo(makers, turn, Noise{}, runs_of(options), options.seed);
        for (std::size_t i = 0; i < all.size(); i++) {
            exact_rows(all[i], turn);
            for (std::size_t w = 0; w < window_count; w++) {
                row(std::string("filters_") + turn.name, all[i].title, all[i].arithmetic,
                    std::string("mse_") + windows[w].name, scores[i].mse_deg2[w], runs_of(options));
            }
        }
        progress.advance();
    }
}
} // namespace papers::roll
