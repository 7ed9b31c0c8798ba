/*
 * The filters and their yardsticks together do not fit the flash: an image times one part of them. A filter in no part
 * is missed by tools/bench.py.
 */
#ifndef BENCH_PART_H
#define BENCH_PART_H

#ifndef BENCH_PART
#define BENCH_PART 1
#endif

#if BENCH_PART == 1
#define BENCH_LIST(X) X(kf) X(sprf) X(synth) X(lrf) X(auto)
#elif BENCH_PART == 2
#define BENCH_LIST(X) X(soft) X(sprf_paper) X(shrf) X(pbf) X(af)
#elif BENCH_PART == 3
#define BENCH_LIST(X) X(synth_opt) X(synth_plus) X(kf3) X(adaptive)
#else
#error "BENCH_PART is 1, 2 or 3"
#endif

#endif
