/*
 * Two places in the firmware that the simulator can time: link-time optimisation leaves no function boundary of its own
 * around a sample's way. app.c of the image calls these instead of the functions that they call (make bench).
 */
#include "adxl345.h"
#include "base/health.h"
#include "path/pipeline.h"

void bench_sample_begins(const adxl345_sample_t *sample);
void bench_sample_ends(void);

void __attribute__((noinline, noclone)) bench_sample_begins(const adxl345_sample_t *sample)
{
    pipeline_sample(sample);
}

void __attribute__((noinline, noclone)) bench_sample_ends(void)
{
    health_sample_filtered();
}
