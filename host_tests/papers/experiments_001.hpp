// The experiments of paper 001. 10,000 runs of paper 002 count as 2,000 here.
#ifndef PAPERS_EXPERIMENTS_001_H
#define PAPERS_EXPERIMENTS_001_H

#include "report.hpp"

namespace papers::altitude
{
// The synthesised filter and both Kalman filters, in double, by every reading of what the paper leaves open.
void readings(const Options &options);

// Every filter of FILTER_LIST on the same altitude.
void shipped_filters(const Options &options);
} // namespace papers::altitude

#endif
