/*
 * Real recordings: ../shared/streams, or the folder that RECORDINGS names (it holds open/ and test-only/, each with an
 * index.csv). They are other people's and never part of this repository: without them the tests that want them are
 * skipped.
 */
#ifndef SUPPORT_RECORDINGS_H
#define SUPPORT_RECORDINGS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define RECORDINGS_MAX 64U

/* A row of the index. */
typedef struct {
    char path[512];
    char name[40];
    size_t rows;
    uint16_t rate_dhz; /* nominal, of the sensor */
    uint8_t range_g;   /* 16 where the index does not know */
    double step_us;    /* median of the rows' steps */
    double clipped;    /* share of rows with an axis at the rail */
    double duplicates; /* share of rows equal to the one before */
    size_t zeros;      /* rows 0,0,0 */
    size_t ones;       /* rows -1,-1,-1 */
} recording_t;

typedef struct {
    recording_t list[RECORDINGS_MAX];
    size_t count;
    char error[700]; /* why loading failed */
} recordings_t;

/* The folder in use. */
const char *recordings_folder(void);

/* False when the folder is not there: skip. Never false when RECORDINGS names it: then that is an error of loading. */
bool recordings_there(void);

/* Reads both indices. */
bool recordings_load(recordings_t *recordings);

/* NULL when there is none of this name. */
const recording_t *recordings_find(const recordings_t *recordings, const char *name);

/* A stretch at rest of a recording. */
typedef struct {
    const char *name;
    double from_s, to_s;
} rest_t;

/* As judged when the noise estimate was made (test_noise_reference.c). */
#define RESTS 13U
extern const rest_t recording_rests[RESTS];

#endif
