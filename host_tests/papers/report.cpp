#include "experiments.hpp"

#include <cmath>
#include <cstdio>

namespace papers
{
namespace
{
std::string number(double value)
{
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%.9g", value);
    return buffer;
}

void print(const std::string &experiment, const Contestant &c, const std::string &metric, const std::string &value,
           const std::string &interval, int runs)
{
    std::printf("row\t%s\t%s\t%s\t%s\t%s\t%s\t%d\n", experiment.c_str(), c.name.c_str(), text(c.arithmetic),
                metric.c_str(), value.c_str(), interval.c_str(), runs);
}
} // namespace

void row(const std::string &experiment, const Contestant &c, const std::string &metric, double value, int runs)
{
    print(experiment, c, metric, number(value), "\t", runs);
}

void row(const std::string &experiment, const Contestant &c, const std::string &metric, const Interval &value, int runs)
{
    print(experiment, c, metric, number(value.value), number(value.low) + "\t" + number(value.high), runs);
}

void Progress::advance(double by)
{
    done_ += by;
    const int percent = static_cast<int>(100.0 * done_ / work_);
    if (percent > told_) {
        told_ = percent;
        std::printf("progress\t%.2f\n", done_ / work_);
        std::fflush(stdout);
    }
}
} // namespace papers
