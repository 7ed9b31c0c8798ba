// paper002 --list | EXPERIMENT [--runs N] [--seed N]: one experiment; campaigns/papers/papers.py runs them side by
// side and judges.
#include "experiments.hpp"

int main(int argc, char **argv)
{
    return papers::program("paper002",
                           {
                               { "lockout", 30, papers::lockout },
                               { "steps_with_outliers", 20, papers::steps_with_outliers },
                               { "wrong_r", 15, papers::wrong_r },
                               { "steps_clean", 10, papers::steps_clean },
                               { "table1_start", 6, papers::table1_start },
                               { "first_sample_clean", 6, papers::first_sample_clean },
                               { "median_start", 6, papers::median_start },
                               { "shipped_start", 6, papers::shipped_start },
                               { "gate_width", 6, papers::gate_width },
                               { "printed_readings", 6, papers::printed_readings },
                               { "clean_data", 4, papers::clean_data },
                               { "bursts", 4, papers::bursts },
                               { "covariance", 0.1, papers::covariance },
                               { "steady_gain", 0.1, papers::steady_gain },
                               { "table2", 0.1, papers::table2 },
                           },
                           argc, argv);
}
