/*
 * Sensors that a board sold with an ADXL345 may carry instead: same package or same registers, other characteristics.
 * One row each; the model (adxl345_model.h) is the same for all of them.
 */
#ifndef ADXL345_VARIANTS_H
#define ADXL345_VARIANTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
    const char *name;
    uint8_t device_id;        /* DEVID; for the ADXL313 DEVID_0 */
    double lsb_per_g;         /* typical, in full resolution */
    double range_g;           /* of range code 3; each lower code halves it, unless one_range */
    bool one_range;           /* 13 bits at range_g, whatever FULL_RES and the range bits of DATA_FORMAT say */
    int16_t self_test_lsb[3]; /* shift by SELF_TEST on x, y, z in full resolution; 0 if no figure was found */
} adxl345_variant_t;

extern const adxl345_variant_t adxl345_variants[];
extern const size_t adxl345_variant_count;

/* The first row, the ADXL345 itself. */
extern const adxl345_variant_t *const adxl345_itself;

/* NULL: no row has this name. */
const adxl345_variant_t *adxl345_variant_named(const char *name);

#endif
