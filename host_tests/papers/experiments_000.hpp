// The experiments of paper 000. 10,000 runs of paper 002 count as 4,000 here.
#ifndef PAPERS_EXPERIMENTS_000_H
#define PAPERS_EXPERIMENTS_000_H

#include "report.hpp"

namespace papers::roll
{
int runs_of(const Options &options);

// The reference table: constant gains from x^ = g(0), in double exactly and by Monte Carlo, and the shipped `synth`.
void reference_table(const Options &options);

// The synthesised filter and others of the same noise gain, without noise, over all profiles.
void equal_noise(const Options &options);

// The gains of (22), as printed and mended: shares, cycles, true variance; and the roll filtered with them.
void schedules(const Options &options);

// How near any reading comes to the paper's Table 1.
void table1_search(const Options &options);

// Every filter of FILTER_LIST as shipped over all profiles.
void all_filters(const Options &options);

// adaptive without its guard and with several, on clean samples and with outliers.
void adaptive(const Options &options);

// R as noise.c identifies it in 10 s, at rest, in motion and with bad reads.
void noise(const Options &options);

// Roll filtered as an angle against filtered axes, on the shipped tilt streams.
void roll_as_angle(const Options &options);
} // namespace papers::roll

#endif
