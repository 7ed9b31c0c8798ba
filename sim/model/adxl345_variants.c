/*
 * Sources: "p." is a page of the part's own data sheet by Analog Devices (ADXL345 Rev. E, ADXL346 Rev. C, ADXL312 and
 * ADXL375 Rev. B). Where a page was not available, the values come from others who used it: the drivers of Analog
 * Devices ("no-OS": drivers/accel/adxl313/adxl313.h), Linux (drivers/input/misc/adxl34x.c) and Zephyr (adxl34x), and
 * distributors' extracts. All have the rate codes of the ADXL345 in 0x2C and its FIFO in 0x38 and 0x39.
 *
 * Self-test: the middle of the limits, times the factor for a supply of 3.3 V (ADXL345 p. 31: 1.77 on x and y, 1.47 on
 * z), or the typical value if that is given.
 */
#include "adxl345_variants.h"

#include <string.h>

const adxl345_variant_t adxl345_variants[] = {
    /* 256 LSB/g: p. 4; DEVID: p. 24; self-test: 50..540, -540..-50, 75..875 LSB at 2.5 V, p. 5 and 31 */
    { "adxl345", 0xE5, 256.0, 16.0, false, { 522, -522, 698 } },
    /* 3.9 mg/LSB, 16 g: p. 1; FULL_RES and range: p. 25; DEVID: Zephyr; self-test not read, taken as equal */
    { "adxl343", 0xE5, 256.0, 16.0, false, { 522, -522, 698 } },
    /* 3.9 mg/LSB, supply 1.7 to 2.75 V: p. 1; DEVID: Zephyr; self-test not read, taken as the ADXL345's at 2.5 V */
    { "adxl344", 0xE6, 256.0, 16.0, false, { 295, -295, 475 } },
    /* 4 mg/LSB, supply 1.7 to 2.75 V: p. 1; DEVID: Linux, Zephyr; self-test as above */
    { "adxl346", 0xE6, 256.0, 16.0, false, { 295, -295, 475 } },
    /*
     * 200 g: p. 1; 20.5 LSB/g (18.4 to 22.6): distributors; self-test 6.4 g on z, DEVID: drivers; no figure found for x
     * and y. DATA_FORMAT: D3, D1 and D0 are to be written as 1; the effect of other values is not specified: here they
     * are kept and change nothing.
     */
    { "adxl375", 0xE5, 20.5, 200.0, true, { 0, 0, 131 } },
    /*
     * 2.9 mg/LSB in full resolution, 1.5 to 12 g: p. 1; DEVID: p. 21; self-test: 8..90 LSB on x in 10 bits at 12 g and
     * 2.5 V: Table 17, 0.3 to 3.4 g on z: no-OS
     */
    { "adxl312", 0xE5, 1000.0 / 2.9, 12.0, false, { 694, -694, 938 } },
    /* 1024 LSB/g, 0.5 to 4 g, self-test 0.20..2.36, -2.36..-0.20, 0.30..3.70 g up to 3.6 V: p. 3; DEVID_0: no-OS */
    { "adxl313", 0xAD, 1024.0, 4.0, false, { 1311, -1311, 2048 } },
    /* 200 g in fixed 13 bits: p. 1; 48.83 mg/LSB, DEVID, self-test 0.1 to 8 g on z: no-OS; none found for x and y */
    { "adxl314", 0xE5, 1000.0 / 48.83, 200.0, true, { 0, 0, 83 } },
};
const size_t adxl345_variant_count = sizeof adxl345_variants / sizeof adxl345_variants[0];
const adxl345_variant_t *const adxl345_itself = &adxl345_variants[0];

const adxl345_variant_t *adxl345_variant_named(const char *name)
{
    for (size_t i = 0; i < adxl345_variant_count; i++) {
        if (strcmp(adxl345_variants[i].name, name) == 0) {
            return &adxl345_variants[i];
        }
    }
    return NULL;
}
