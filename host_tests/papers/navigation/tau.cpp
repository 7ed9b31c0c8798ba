// Paper 003, 3.3.3: the matrix that turns the direction of the Earth's field onto the first axis.
#include "navigation.hpp"

#include "reference_nav.h"

#include <array>
#include <cmath>

namespace papers::navigation
{
namespace
{
constexpr std::array<double, 3> field_nt{ 17818.0, 1951.0, 41847.0 };
constexpr double degree = 57.29577951308232;

std::string element(std::size_t i)
{
    return "tau_" + std::to_string(i / 3 + 1) + std::to_string(i % 3 + 1);
}

void of_thesis(const std::array<double, 3> &unit)
{
    std::array<double, 9> matrix{};
    reference_nav_tau(matrix.data(), unit.data(), false);
    for (std::size_t i = 0; i < 9; i++) {
        row("tau", "thesis", Arithmetic::in_double, element(i), matrix[i], 1);
    }
}

// nav/lib keeps rows 2 and 3; the first is the field's direction
void of_ours(const nav_variant_t &variant)
{
    std::array<double, 6> rows{};
    variant.tau(rows.data(), field_nt.data());
    for (std::size_t i = 0; i < 6; i++) {
        row("tau", "lib_nav", arithmetic_of(variant), element(3 + i), rows[i], 1);
    }
}
} // namespace

void tau(const Options &)
{
    const double level = std::hypot(field_nt[0], field_nt[1]);
    const double length = std::hypot(level, field_nt[2]);
    row("tau", "thesis", Arithmetic::in_double, "dip", degree * std::atan2(field_nt[2], level), 1);
    row("tau", "thesis", Arithmetic::in_double, "declination", degree * std::atan2(field_nt[1], field_nt[0]), 1);
    of_thesis({ field_nt[0] / length, field_nt[1] / length, field_nt[2] / length });
    of_ours(n9d);
    of_ours(n9f);
}
} // namespace papers::navigation
