// paper004_board --list | EXPERIMENT [--runs N] [--seed N]: what of paper 004 runs on the board.
#include "board_phases.hpp"

int main(int argc, char **argv)
{
    return papers::program("paper004_board", { { "board_phases", 8, papers::board::phases } }, argc, argv);
}
