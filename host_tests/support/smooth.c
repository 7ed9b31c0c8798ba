#include "support/smooth.h"

#include "support/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* y = b0 (x + 2 x1 + x2) - a1 y1 - a2 y2, from the steady state of its first value. */
typedef struct {
    double b0, a1, a2;
} low_pass_t;

/* By the bilinear transform, bent so that the cut stays where it is. */
static low_pass_t low_pass(double rate_hz, double cut_hz)
{
    double k = tan(pi * cut_hz / rate_hz);
    double norm = 1.0 / (1.0 + sqrt(2.0) * k + k * k);
    low_pass_t f = { k * k * norm, 2.0 * (k * k - 1.0) * norm, (1.0 - sqrt(2.0) * k + k * k) * norm };
    return f;
}

static void run_low_pass(const low_pass_t *f, double *value, size_t count, bool backwards)
{
    double x1 = value[backwards ? count - 1 : 0];
    double x2 = x1;
    double y1 = x1;
    double y2 = x1;
    for (size_t i = 0; i < count; i++) {
        double *at = &value[backwards ? count - 1 - i : i];
        double x = *at;
        *at = f->b0 * (x + 2.0 * x1 + x2) - f->a1 * y1 - f->a2 * y2;
        x2 = x1;
        x1 = x;
        y2 = y1;
        y1 = *at;
    }
}

bool smooth_both_ways(double *value, size_t count, double rate_hz, double cut_hz)
{
    if (count < 2) {
        return false;
    }
    size_t second = (size_t)rate_hz;
    size_t pad = second < count - 1 ? second : count - 1;
    double *padded = malloc((count + 2 * pad) * sizeof *padded);
    if (padded == NULL) {
        return false;
    }
    memcpy(padded + pad, value, count * sizeof *value);
    for (size_t i = 1; i <= pad; i++) {
        padded[pad - i] = 2.0 * value[0] - value[i];
        padded[pad + count - 1 + i] = 2.0 * value[count - 1] - value[count - 1 - i];
    }
    low_pass_t f = low_pass(rate_hz, cut_hz);
    run_low_pass(&f, padded, count + 2 * pad, false);
    run_low_pass(&f, padded, count + 2 * pad, true);
    memcpy(value, padded + pad, count * sizeof *value);
    free(padded);
    return true;
}

static bool cut_by_gap(const stream_t *whole, size_t row, double period_us)
{
    return (double)(whole->rows[row].t_us - whole->rows[row - 1].t_us) > 1.5 * period_us;
}

static void append_group(divided_t *divided, const stream_t *whole, size_t last)
{
    size_t at = divided->stream.count++;
    divided->last[at] = last;
    stream_row_t *row = &divided->stream.rows[at];
    *row = whole->rows[last];
    for (int axis = 0; axis < 3; axis++) {
        double sum = 0.0;
        for (size_t i = 0; i < divided->divide; i++) {
            sum += whole->rows[last - i].lsb[axis];
        }
        row->lsb[axis] = as_sample(sum / (double)divided->divide);
    }
}

bool stream_divide(divided_t *divided, const stream_t *whole, unsigned divide)
{
    memset(divided, 0, sizeof *divided);
    divided->divide = divide;
    divided->stream.has_truth = whole->has_truth;
    divided->stream.rate_hz = whole->rate_hz / divide;
    divided->stream.rows = calloc(whole->count / divide + 1, sizeof *divided->stream.rows);
    divided->last = calloc(whole->count / divide + 1, sizeof *divided->last);
    size_t filled = 0;
    for (size_t row = 0; divided->stream.rows != NULL && divided->last != NULL && row < whole->count; row++) {
        bool cut = divide > 1 && filled > 0 && cut_by_gap(whole, row, 1e6 / whole->rate_hz);
        filled = cut ? 1 : filled + 1;
        if (filled == divide) {
            append_group(divided, whole, row);
            filled = 0;
        }
    }
    if (divided->stream.count < 2) {
        divided_free(divided);
        return false;
    }
    return true;
}

void divided_free(divided_t *divided)
{
    stream_free(&divided->stream);
    free(divided->last);
    divided->last = NULL;
}

double divided_mean(const divided_t *divided, size_t group, const double *value)
{
    double sum = 0.0;
    for (size_t i = 0; i < divided->divide; i++) {
        sum += value[divided->last[group] - i];
    }
    return sum / (double)divided->divide;
}
