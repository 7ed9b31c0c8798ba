// paper001 --list | EXPERIMENT [--runs N] [--seed N]: the experiments of paper 001.
#include "experiments_001.hpp"

int main(int argc, char **argv)
{
    using namespace papers::altitude;
    return papers::program("paper001", { { "altitude", 3, readings }, { "altitude_shipped", 3, shipped_filters } },
                           argc, argv);
}
