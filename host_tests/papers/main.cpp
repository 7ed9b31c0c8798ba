// paper002 --list | EXPERIMENT [--runs N] [--seed N]: one experiment; tools/papers.py runs them side by side and
// judges.
#include "experiments.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <stdexcept>

namespace
{
struct Entry {
    const char *name;
    double work; // relative time, for the progress of all
    void (*run)(const papers::Options &options);
};

const Entry entries[] = {
    { "lockout", 30, papers::lockout },          { "steps_with_outliers", 20, papers::steps_with_outliers },
    { "wrong_r", 15, papers::wrong_r },          { "steps_clean", 10, papers::steps_clean },
    { "table1_start", 6, papers::table1_start }, { "first_sample_clean", 6, papers::first_sample_clean },
    { "median_start", 6, papers::median_start }, { "shipped_start", 6, papers::shipped_start },
    { "gate_width", 6, papers::gate_width },     { "printed_readings", 6, papers::printed_readings },
    { "clean_data", 4, papers::clean_data },     { "bursts", 4, papers::bursts },
    { "covariance", 0.1, papers::covariance },   { "steady_gain", 0.1, papers::steady_gain },
    { "table2", 0.1, papers::table2 },
};

long whole_number(const char *option, const char *word)
{
    char *end = nullptr;
    const long value = (word == nullptr) ? 0 : std::strtol(word, &end, 10);
    if (word == nullptr || end == word || *end != '\0' || value < 1 || value > 10000000) {
        throw std::runtime_error(std::string(option) + ": takes a whole number from 1 to 10000000");
    }
    return value;
}

papers::Options options_of(int argc, char **argv)
{
    papers::Options options;
    for (int i = 2; i < argc; i += 2) {
        if (std::strcmp(argv[i], "--runs") == 0) {
            options.runs = static_cast<int>(whole_number("--runs", argv[i + 1]));
        } else if (std::strcmp(argv[i], "--seed") == 0) {
            options.seed = static_cast<std::uint64_t>(whole_number("--seed", argv[i + 1]));
        } else {
            throw std::runtime_error(std::string(argv[i]) + ": unknown option (--runs N, --seed N)");
        }
    }
    return options;
}

int run(int argc, char **argv)
{
    const std::string word = (argc > 1) ? argv[1] : "";
    if (word == "--list") {
        for (const Entry &entry : entries) {
            std::printf("%s\t%g\n", entry.name, entry.work);
        }
        return 0;
    }
    for (const Entry &entry : entries) {
        if (word == entry.name) {
            entry.run(options_of(argc, argv));
            return 0;
        }
    }
    throw std::runtime_error("'" + word + "': no such experiment (--list tells them)");
}
} // namespace

int main(int argc, char **argv)
{
    try {
        return run(argc, argv);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "paper002: %s\n", error.what());
        return 2;
    }
}
