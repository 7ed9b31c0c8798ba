/*
 * In place of the filters: an estimate that is the sample. pipeline.c of the image calls this instead of
 * filter_update, so that the processor's load is the rest of a sample's way (campaigns/bench/bench.py).
 */
#include "filter_list.h"

int32_t bench_no_filter(filter_t *f, int16_t z_lsb);

int32_t __attribute__((noinline, noclone)) bench_no_filter(filter_t *f, int16_t z_lsb)
{
    (void)f;
    return (int32_t)z_lsb * 65536;
}
