#include "report.hpp"

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

void print(const std::string &experiment, const std::string &filter, Arithmetic arithmetic, const std::string &metric,
           const std::string &values, int runs)
{
    std::printf("row\t%s\t%s\t%s\t%s\t%s\t%d\n", experiment.c_str(), filter.c_str(), text(arithmetic), metric.c_str(),
                values.c_str(), runs);
}
} // namespace

const char *text(Arithmetic arithmetic)
{
    switch (arithmetic) {
    case Arithmetic::in_double:
        return "double";
    case Arithmetic::in_float:
        return "float";
    default:
        return "fixed";
    }
}

void row(const std::string &experiment, const std::string &filter, Arithmetic arithmetic, const std::string &metric,
         double value, int runs)
{
    print(experiment, filter, arithmetic, metric, number(value) + "\t\t", runs);
}

void row(const std::string &experiment, const std::string &filter, Arithmetic arithmetic, const std::string &metric,
         const Interval &value, int runs)
{
    print(experiment, filter, arithmetic, metric,
          number(value.value) + "\t" + number(value.low) + "\t" + number(value.high), runs);
}
} // namespace papers
