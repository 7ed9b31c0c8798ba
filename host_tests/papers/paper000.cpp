// paper000 --list | EXPERIMENT [--runs N] [--seed N]: the experiments of paper 000.
#include "experiments_000.hpp"

int main(int argc, char **argv)
{
    using namespace papers::roll;
    return papers::program("paper000",
                           { { "all_filters", 10, all_filters },
                             { "adaptive", 6, adaptive },
                             { "noise", 1, noise },
                             { "roll_reference", 1, reference_table },
                             { "table1_search", 3, table1_search },
                             { "schedules", 2, schedules },
                             { "equal_noise", 1, equal_noise },
                             { "roll_as_angle", 1, roll_as_angle } },
                           argc, argv);
}
