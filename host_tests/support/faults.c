#include "support/faults.h"

#include "support/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define RUN_MAX 9

static const char *const fault_names[FAULT_COUNT] = { "bad reads 1e-5",  "bad reads 1e-4",  "bad reads 1e-3",
                                                      "contention 20 %", "duplicates 39 %", "clipping bursts",
                                                      "jitter" };

const char *fault_name(fault_t fault)
{
    return fault_names[fault];
}

static bool append(faulty_t *f, const stream_t *clean, size_t source, uint64_t t_us)
{
    size_t at = f->stream.count;
    f->stream.rows[at] = clean->rows[source];
    f->stream.rows[at].t_us = t_us;
    f->source[at] = source;
    f->stream.count++;
    return at > 0 && f->source[at] == f->source[at - 1];
}

/* --- forms of a bad read --- */

static void garble(int16_t *lsb, test_random_t *random)
{
    uint32_t high = random_below(random, 3);
    for (uint32_t axis = 0; axis < 3; axis++) {
        lsb[axis] = (int16_t)random_below(random, 16);
    }
    lsb[high] = (int16_t)(lsb[high] + 256 * (int16_t)(1 + random_below(random, 8)));
}

static void spoil(int16_t *lsb, test_random_t *random)
{
    uint32_t form = random_below(random, 5);
    uint32_t axis = random_below(random, 3);
    switch (form) {
    case 0:
    case 1:
        lsb[0] = lsb[1] = lsb[2] = (int16_t)(form == 0 ? 0 : -1);
        break;
    case 2:
        lsb[axis] = 0;
        break;
    case 3:
        garble(lsb, random);
        break;
    default:
        lsb[axis] = as_sample(2.0 * lsb[axis]);
        break;
    }
}

static void make_bad_reads(faulty_t *f, const stream_t *clean, double rate, test_random_t *random)
{
    for (size_t i = 0; i < clean->count; i++) {
        (void)append(f, clean, i, clean->rows[i].t_us);
        if (random_uniform(random) < rate) {
            spoil(f->stream.rows[i].lsb, random);
            f->faulty++;
        }
    }
}

/* --- contention --- */

/* Recorded runs of 1, 2, 3: 363, 237, 140; beyond, up to 9, each 0.6 of the one before, as these three go. */
static unsigned run_length(test_random_t *random)
{
    static const double share[RUN_MAX] = { 363, 237, 140, 84, 50.4, 30.2, 18.1, 10.9, 6.5 };
    double sum = 0.0;
    for (int i = 0; i < RUN_MAX; i++) {
        sum += share[i];
    }
    double left = sum * random_uniform(random);
    unsigned length = 1;
    for (int i = 0; i < RUN_MAX - 1 && left > share[i]; i++, length++) {
        left -= share[i];
    }
    return length;
}

static int heaviest_axis(const int16_t *lsb)
{
    int axis = abs(lsb[1]) > abs(lsb[0]) ? 1 : 0;
    return abs(lsb[2]) > abs(lsb[axis]) ? 2 : axis;
}

/* A run begins after a good read with 0.2 / 0.8 / 2.45: 2.45 is the mean length. */
static void make_contention(faulty_t *f, const stream_t *clean, test_random_t *random)
{
    unsigned left = 0;
    int axis = 0;
    bool bad_before = false;
    for (size_t i = 0; i < clean->count; i++) {
        (void)append(f, clean, i, clean->rows[i].t_us);
        int16_t *lsb = f->stream.rows[i].lsb;
        if (left == 0 && !bad_before && random_uniform(random) < 0.2 / 0.8 / 2.45) {
            left = run_length(random);
            axis = heaviest_axis(lsb);
        }
        bad_before = left > 0;
        if (left > 0) {
            lsb[axis] = as_sample(2.0 * lsb[axis]);
            f->faulty++;
            left--;
        }
    }
}

/* --- time --- */

/* 0.39 / 0.61 of the rows are read twice. */
static void make_duplicates(faulty_t *f, const stream_t *clean, uint64_t period_us, test_random_t *random)
{
    for (size_t i = 0; i < clean->count; i++) {
        (void)append(f, clean, i, clean->rows[i].t_us);
        if (random_uniform(random) < 0.39 / 0.61) {
            f->faulty += append(f, clean, i, clean->rows[i].t_us + period_us / 2U);
        }
    }
}

static void make_jitter(faulty_t *f, const stream_t *clean, uint64_t period_us, test_random_t *random)
{
    double t_us = 0.5 * (double)period_us;
    size_t i = 0;
    while (i + 1 < clean->count && f->stream.count < 2 * clean->count) {
        while (i + 1 < clean->count && (double)clean->rows[i + 1].t_us <= t_us) {
            i++;
        }
        f->faulty += append(f, clean, i, (uint64_t)t_us);
        double periods = 1.0 + 0.1 * random_normal(random);
        if (random_uniform(random) < 0.01) {
            periods = 1.5 + 1.5 * random_uniform(random);
        }
        t_us += fmax(0.3, periods) * (double)period_us;
    }
}

/* --- clipping --- */

typedef struct {
    double end_s, amplitude_lsb, hz;
    double phase[3];
} burst_t;

static burst_t new_burst(double t_s, test_random_t *random)
{
    burst_t burst;
    burst.end_s = t_s + 0.05 + 0.45 * random_uniform(random);
    burst.amplitude_lsb = 300.0 + 600.0 * random_uniform(random);
    burst.hz = 20.0 + 25.0 * random_uniform(random);
    for (int axis = 0; axis < 3; axis++) {
        burst.phase[axis] = 6.2831853 * random_uniform(random);
    }
    return burst;
}

/* Bursts of 0.275 s in the mean, pauses of 1.1 s. */
static void make_clipping(faulty_t *f, const stream_t *clean, test_random_t *random)
{
    burst_t burst = { 0 };
    double next_s = 1.1;
    for (size_t i = 0; i < clean->count; i++) {
        double t_s = 1e-6 * (double)clean->rows[i].t_us;
        (void)append(f, clean, i, clean->rows[i].t_us);
        if (t_s >= next_s) {
            burst = new_burst(t_s, random);
            next_s = burst.end_s + 0.1 + 2.0 * random_uniform(random);
        }
        bool shaken = t_s < burst.end_s;
        f->faulty += shaken;
        for (int axis = 0; axis < 3; axis++) {
            double shake = shaken ? burst.amplitude_lsb * sin(6.2831853 * burst.hz * t_s + burst.phase[axis]) : 0.0;
            double lsb = f->stream.rows[i].lsb[axis] + shake;
            f->stream.rows[i].lsb[axis] = as_sample(fmax(-512.0, fmin(511.0, lsb)));
        }
    }
    f->range_g = 2;
}

bool faulty_begin(faulty_t *faulty, const stream_t *clean, uint8_t range_g)
{
    memset(faulty, 0, sizeof *faulty);
    faulty->range_g = range_g;
    faulty->stream.rate_hz = clean->rate_hz;
    faulty->stream.rows = calloc(2 * clean->count + 1, sizeof *faulty->stream.rows);
    faulty->source = calloc(2 * clean->count + 1, sizeof *faulty->source);
    if (faulty->stream.rows == NULL || faulty->source == NULL) {
        faulty_free(faulty);
        return false;
    }
    return true;
}

bool faulty_make(faulty_t *faulty, const stream_t *clean, fault_t fault, uint16_t rate_dhz, uint8_t range_g,
                 uint64_t seed)
{
    static const double bad_rate[] = { 1e-5, 1e-4, 1e-3 };
    if (!faulty_begin(faulty, clean, range_g)) {
        return false;
    }
    test_random_t random;
    random_seed(&random, seed);
    uint64_t period_us = 10000000U / rate_dhz;
    switch (fault) {
    case FAULT_CONTENTION:
        make_contention(faulty, clean, &random);
        break;
    case FAULT_DUPLICATES:
        make_duplicates(faulty, clean, period_us, &random);
        break;
    case FAULT_CLIPPING:
        make_clipping(faulty, clean, &random);
        break;
    case FAULT_JITTER:
        make_jitter(faulty, clean, period_us, &random);
        break;
    default:
        make_bad_reads(faulty, clean, bad_rate[fault], &random);
        break;
    }
    return true;
}

void faulty_free(faulty_t *faulty)
{
    stream_free(&faulty->stream);
    free(faulty->source);
    faulty->source = NULL;
}
