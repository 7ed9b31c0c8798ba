/*
 * Inside the driver: is what a burst brought a reading of this sensor? Main only.
 *
 * A burst goes from INT_SOURCE through the data to FIFO_STATUS, or ends after DATA_FORMAT where INT_SOURCE has no
 * sample ready. The pattern in FIFO_CTL is what no reset leaves and what no dead bus reads as, so a sensor that has
 * lost its supply, a byte or a bit that slipped and a wire that came off show, and no sample of such a burst goes out.
 */
#ifndef ADXL345_INTEGRITY_H
#define ADXL345_INTEGRITY_H

#include <stdbool.h>
#include <stdint.h>

#include "adxl345.h"

/* The bytes of a reading: INT_SOURCE, DATA_FORMAT, six of data, FIFO_CTL, FIFO_STATUS. */
enum {
    READING_SOURCE = 0,
    READING_FORMAT = 1,
    READING_DATA = 2,
    READING_FIFO_CTL = 8,
    READING_FIFO_STATUS = 9,
    READING_BYTES = 10
};

typedef enum {
    READING_NONE,  /* no burst ended since the last look */
    READING_GOOD,  /* a sample */
    READING_EMPTY, /* the sensor had none */
    READING_BAD,   /* torn, shifted, or nobody there */
    READING_RESET, /* registers as after power-on: the sensor has lost its configuration */
    READING_FAILED /* the transfer did */
} reading_t;

/* Readings come with this configuration's range and self-test from now on, the first after no other. */
void adxl345_integrity_start(const adxl345_config_t *config);

/* The sensor may be another: no value is known to repeat, and INT1 not to be stuck. */
void adxl345_integrity_forget(void);

/*
 * The verdict on a reading, which is counted. lsb: its data, x, y, z as in adxl345_sample_t, valid when GOOD; last_lsb:
 * those of the last one that was GOOD.
 */
reading_t adxl345_integrity_judge(const uint8_t reading[READING_BYTES], int16_t lsb[3], const int16_t last_lsb[3]);

/* A reading was EMPTY although INT1 was high. */
void adxl345_integrity_int1_lied(void);

/*
 * The newest good reading is at least the tenth in a row that is equal on all axes.
 *
 * Noise does that at rest with a chance of sum over k of p(k)^10 for each axis, p(k) the chance of code k; it is
 * greatest where the true value is a whole code. The least noise is that of 100 Hz and below: 0.75, 0.75 and 1.1 LSB
 * rms (data sheet, p. 4 and 33; at every range, because full resolution keeps the LSB), which gives 2.3e-11 a sample,
 * and 6.0e-11 with that of the quietest recording (0.72, 0.78, 0.99). The chance of two equal ones, 0.036, to the
 * seventh power is 8e-11 too, but repeats are not independent: once a code is the likeliest one it stays so, and eight
 * equal ones have 3.3e-9.
 */
#define ADXL345_STUCK_REPEATS 9u
bool adxl345_integrity_stuck(void);

/* Why the sensor must be configured again: ADXL345_FAULT_NO_DATA, ADXL345_FAULT_TORN, or NONE. */
adxl345_fault_t adxl345_integrity_fault(void);

/* INT1 lied three times without a good reading that left it low; until 32 of those have left INT1 low. */
bool adxl345_integrity_int1_stuck(void);

#endif
