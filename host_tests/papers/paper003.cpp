// paper003 --list | EXPERIMENT [--runs N] [--seed N]: the experiments of paper 003.
#include "navigation/navigation.hpp"

int main(int argc, char **argv)
{
    using namespace papers::navigation;
    return papers::program("paper003",
                           { { "tau", 0.01, tau },
                             { "covariance", 1.5, covariance },
                             { "closed_loop", 65, closed_loop },
                             { "closed_loop_100_hz", 52, closed_loop_100_hz },
                             { "closed_loop_100_hz_25_q", 65, closed_loop_100_hz_25_q } },
                           argc, argv);
}
