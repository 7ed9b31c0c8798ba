// paper000 --list | EXPERIMENT [--runs N] [--seed N]: the experiments of paper 000.
#include "experiments_000.hpp"

int main(int argc, char **argv)
{
    return papers::program("paper000", { { "roll_reference", 1, papers::roll::reference_table } }, argc, argv);
}
