// paper003 --list | EXPERIMENT [--runs N] [--seed N]: the experiments of paper 003.
#include "navigation/navigation.hpp"

int main(int argc, char **argv)
{
    using namespace papers::navigation;
    return papers::program("paper003",
                           { { "tau", 0.01, tau },
                             { "covariance", 1, covariance },
                             { "closed_loop", 7, closed_loop },
                             { "closed_loop_100_hz", 8, closed_loop_100_hz } },
                           argc, argv);
}
