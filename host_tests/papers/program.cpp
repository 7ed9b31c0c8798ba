// The command line of the papers' programs.
#include "report.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <stdexcept>

namespace papers
{
namespace
{
long whole_number(const char *option, const char *word)
{
    char *end = nullptr;
    const long value = (word == nullptr) ? 0 : std::strtol(word, &end, 10);
    if (word == nullptr || end == word || *end != '\0' || value < 1 || value > 10000000) {
        throw std::runtime_error(std::string(option) + ": takes a whole number from 1 to 10000000");
    }
    return value;
}

Options options_of(int argc, char **argv)
{
    Options options;
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

int run(const std::vector<Experiment> &experiments, int argc, char **argv)
{
    const std::string word = (argc > 1) ? argv[1] : "";
    if (word == "--list") {
        for (const Experiment &entry : experiments) {
            std::printf("%s\t%g\n", entry.name, entry.work);
        }
        return 0;
    }
    for (const Experiment &entry : experiments) {
        if (word == entry.name) {
            entry.run(options_of(argc, argv));
            return 0;
        }
    }
    throw std::runtime_error("'" + word + "': no such experiment (--list shows them)");
}
} // namespace

int program(const char *name, const std::vector<Experiment> &experiments, int argc, char **argv)
{
    try {
        return run(experiments, argc, argv);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s: %s\n", name, error.what());
        return 2;
    }
}
} // namespace papers
