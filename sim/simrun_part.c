/* --part: what differs from one sensor of a kind to the next. */
#include <stdlib.h>
#include <string.h>

#include "simrun.h"

enum { AXES = 3 };

static bool self_test_named;

/* Three numbers from low to high separated by commas, and nothing after them. */
static bool three(const char *text, double low, double high, double value[AXES])
{
    for (size_t axis = 0; axis < AXES; axis++) {
        char *end;
        value[axis] = strtod(text, &end);
        bool ended = *end == (axis + 1 < AXES ? ',' : '\0');
        if (end == text || !ended || !(value[axis] >= low && value[axis] <= high)) {
            return false;
        }
        text = end + 1;
    }
    return true;
}

static bool whole(const char *text, double low, double high, int16_t lsb[AXES])
{
    double value[AXES];
    if (!three(text, low, high, value)) {
        return false;
    }
    for (size_t axis = 0; axis < AXES; axis++) {
        lsb[axis] = (int16_t)value[axis];
        if (lsb[axis] < value[axis] || lsb[axis] > value[axis]) {
            return false;
        }
    }
    return true;
}

static bool take_one(const char *text, adxl345_part_t *part)
{
    if (strncmp(text, "gain=", 5) == 0) {
        return three(text + 5, 0.5, 2.0, part->gain);
    }
    if (strncmp(text, "offset=", 7) == 0) {
        return whole(text + 7, -1000.0, 1000.0, part->offset_lsb);
    }
    if (strncmp(text, "selftest=", 9) == 0) {
        self_test_named = true;
        return whole(text + 9, -4096.0, 4095.0, part->self_test_lsb);
    }
    return false;
}

void part_complete(const adxl345_variant_t *variant, adxl345_part_t *part)
{
    if (!self_test_named) {
        memcpy(part->self_test_lsb, variant->self_test_lsb, sizeof part->self_test_lsb);
    }
}

bool part_take(const char *argument, adxl345_part_t *part)
{
    char copy[200];
    char *rest = NULL;
    if (strlen(argument) >= sizeof copy) {
        return false;
    }
    strcpy(copy, argument);
    char *one = strtok_r(copy, " ", &rest);
    bool good = one != NULL;
    for (; one != NULL && good; one = strtok_r(NULL, " ", &rest)) {
        good = take_one(one, part);
    }
    return good;
}
