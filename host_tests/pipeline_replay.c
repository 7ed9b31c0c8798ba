/*
 * The sample path alone on the PC: takes the samples (time and readings) out of a run of the firmware, filters them
 * with the same code, and prints the rows anew. On a run without faults, from a cold start on, the two must agree to
 * the last digit.
 *
 *   pipeline_replay RUN.csv FILTER RATE_DHZ RANGE_G SKIP > ROWS.csv      SKIP: data rows before the cold start
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "filter_any.h"
#include "pipeline.h"

int main(int argc, char **argv)
{
    if (argc != 6) {
        fprintf(stderr, "usage: pipeline_replay RUN.csv FILTER RATE_DHZ RANGE_G SKIP\n");
        return 2;
    }
    FILE *run = fopen(argv[1], "r");
    filter_kind_t kind = filter_any_find(argv[2]);
    if (run == NULL || kind == FILTER_KIND_COUNT) {
        fprintf(stderr, "pipeline_replay: cannot open %s, or no filter %s\n", argv[1], argv[2]);
        return 2;
    }
    uint16_t rate_dhz = (uint16_t)atoi(argv[3]);
    long skip = atol(argv[5]);
    pipeline_reset();
    pipeline_start((uint8_t)kind, rate_dhz, (uint8_t)atoi(argv[4]));
    char line[512];
    while (fgets(line, sizeof line, run) != NULL) {
        unsigned t_us;
        int x, y, z;
        if (sscanf(line, "%u,%d,%d,%d", &t_us, &x, &y, &z) != 4 || skip-- > 0) {
            continue;
        }
        adxl345_sample_t sample = { .t_us = t_us, .lsb = { (int16_t)x, (int16_t)y, (int16_t)z } };
        row_t row;
        pipeline_sample(&sample, 10000000ul / rate_dhz);
        pipeline_row(&row);
        pipeline_row_done();
        printf("%u,%d,%d,%d,%d,%d,%d,%d,%d,%u\n", (unsigned)row.t_us, row.lsb[0], row.lsb[1], row.lsb[2], row.mg[0],
               row.mg[1], row.mg[2], row.roll_cdeg, row.pitch_cdeg, row.flags);
    }
    fclose(run);
    return 0;
}
