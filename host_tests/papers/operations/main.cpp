// operations002 --list | operations [--runs N] [--seed N]: what a sample costs each filter of paper 002, counted on the
// shipped code.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "counting.hpp"
#include "filter_list.h"
#include "scope.hpp"
#include "state_bytes.h"
#include "wide.h"

counting::Tally counting::tally{};

namespace
{
// Noise of about 1 LSB, as the default R at 40 Hz has it, every seventh sample 20 LSB off: accepted ones and refused
// ones.
int sample(int k)
{
    const double angle = 160.0 + 40.0 * std::sin(0.01 * k);
    const double noise = 1.0 * std::sin(2.7 * k) + 0.5 * std::cos(11.3 * k);
    return static_cast<int>(std::lround(angle + noise + ((k % 7 == 3) ? ((k % 2 != 0) ? 20.0 : -20.0) : 0.0)));
}

struct Cost {
    std::vector<long> products;
    std::vector<long> sums;
    std::vector<long> divisions;
};

Cost cost(filter_kind_t kind)
{
    const filter_config_t config = filter_defaults(filter_listed(kind), 400);
    filter_t f;
    Cost result;
    if (filter_init(&f, filter_listed(kind), &config) != FILTER_ACCEPTED) {
        return result;
    }
    for (int k = 0; k < 1000; k++) {
        counting::tally = {};
        (void)filter_update(&f, sample(k));
        if (k >= 100) {
            result.products.push_back(counting::tally.products);
            result.sums.push_back(counting::tally.sums);
            result.divisions.push_back(counting::tally.divisions);
        }
    }
    return result;
}

// By what begins it.
own_state own_of(const filter_law_t *law)
{
    return law->start == filter_kalman_start ? OWN_KALMAN : law->start == filter_wide_start ? OWN_WIDE : OWN_MIXTURE;
}

void row(const std::string &name, const char *metric, double value)
{
    std::printf("row\toperations\t%s\tfixed\t%s\t%g\t\t\t1\n", name.c_str(), metric, value);
}

void rows(const std::string &name, const char *metric, std::vector<long> values)
{
    std::sort(values.begin(), values.end());
    row(name, metric, static_cast<double>(values[values.size() / 2]));
    row(name, (std::string(metric) + "_most").c_str(), static_cast<double>(values.back()));
}

int all()
{
    for (std::uint8_t kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        const std::string name = filter_listed_name(static_cast<filter_kind_t>(kind));
        if (!papers::of_paper_002(name)) {
            continue;
        }
        const Cost c = cost(static_cast<filter_kind_t>(kind));
        if (c.products.empty()) {
            std::fprintf(stderr, "operations002: %s refuses its defaults\n", name.c_str());
            return 2;
        }
        rows(name, "multiplications", c.products);
        rows(name, "additions", c.sums);
        rows(name, "divisions", c.divisions);
        row(name, "memory_cells",
            static_cast<double>(state_bytes(own_of(filter_listed(static_cast<filter_kind_t>(kind))))) / 4.0);
    }
    return 0;
}
} // namespace

int main(int argc, char **argv)
{
    const std::string word = (argc > 1) ? argv[1] : "";
    if (word == "--list") {
        std::puts("operations\t0.1");
        return 0;
    }
    if (word != "operations") {
        std::fprintf(stderr, "operations002: '%s': no such experiment (--list tells them)\n", word.c_str());
        return 2;
    }
    return all();
}
