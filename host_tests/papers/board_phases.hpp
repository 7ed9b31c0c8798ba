// The supervisor `auto` on tilt streams of sixteen phases, beside the filters that it is to beat.
#ifndef PAPERS_BOARD_PHASES_H
#define PAPERS_BOARD_PHASES_H

#include "report.hpp"

namespace papers::board
{
// Each filter tuned by its overall error on 60 runs, over a grid around its optimum, and judged on 200 others: rmse and
// rmse_KIND in degree, the parameters found, edges (how many of them lie at the end of their grid), and for `auto` its
// error over each other's with percentiles of 1,000 resamplings of the runs. At --runs 10000; fewer with fewer.
void phases(const Options &options);
} // namespace papers::board

#endif
