// Paper 003: the thesis' square root, two conventional forms and nav/lib's U D U', all about the same true flight.
#include "navigation.hpp"

#include "reference_nav.h"

#include <array>
#include <cmath>
#include <memory>

namespace papers::navigation
{
namespace
{
constexpr std::array<const char *, 12> state_names{ "position_n", "position_e", "position_d", "velocity_n",
                                                    "velocity_e", "velocity_d", "attitude_n", "attitude_e",
                                                    "attitude_d", "drift_x",    "drift_y",    "drift_z" };
constexpr std::array<int, 3> times_s{ 160, 399, 500 };

struct Form {
    std::string name;
    Arithmetic arithmetic;
    int states;
};

void rows(const Form &form, const nav_history_t &history, const nav_history_t &thesis)
{
    const std::string name = form.name + "_" + std::to_string(form.states);
    for (const int t : times_s) {
        for (int i = 0; i < form.states; i++) {
            row("covariance", name, form.arithmetic,
                std::string(state_names[static_cast<std::size_t>(i)]) + "_" + std::to_string(t),
                history.sigma[t - 1][i], 1);
        }
    }
    if (form.name != "thesis") {
        row("covariance", name, form.arithmetic, "largest_difference",
            nav_histories_apart(&history, &thesis, form.states), 1);
    }
}

void references(int states, nav_history_t &thesis)
{
    const auto other = std::make_unique<nav_history_t>();
    nav_history_of_reference(&thesis, REFERENCE_NAV_ROOT, states, 0);
    rows({ "thesis", Arithmetic::in_double, states }, thesis, thesis);
    nav_history_of_reference(other.get(), REFERENCE_NAV_CONVENTIONAL, states, 0);
    rows({ "conventional", Arithmetic::in_double, states }, *other, thesis);
    nav_history_of_reference(other.get(), REFERENCE_NAV_JOSEPH, states, 0);
    rows({ "joseph", Arithmetic::in_double, states }, *other, thesis);
}

void ours(const nav_variant_t &variant, const nav_history_t &thesis)
{
    const auto history = std::make_unique<nav_history_t>();
    for (const bool turns : { false, true }) {
        nav_history_of_ours(history.get(), &variant, turns);
        rows({ turns ? "ud_in_turns" : "ud", arithmetic_of(variant), variant.states }, *history, thesis);
        row("covariance", (turns ? "ud_in_turns_" : "ud_") + std::to_string(variant.states), arithmetic_of(variant),
            "least_d", history->least_d, 1);
    }
}
} // namespace

void covariance(const Options &)
{
    const auto thesis = std::make_unique<nav_history_t>();
    references(9, *thesis);
    ours(n9d, *thesis);
    ours(n9f, *thesis);
    references(12, *thesis);
    ours(n12d, *thesis);
    ours(n12f, *thesis);
}
} // namespace papers::navigation
