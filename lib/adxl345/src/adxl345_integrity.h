/*
 * Inside the driver: did a burst deliver a reading of this sensor? Main only.
 *
 * A burst goes from INT_SOURCE through the data to FIFO_STATUS, or ends after DATA_FORMAT if INT_SOURCE shows no
 * sample. The pattern in FIFO_CTL is one that no reset leaves and no dead bus reads as. So a sensor that has lost its
 * supply, a slipped byte or bit and a loose wire are detected, and no sample of such a burst is delivered.
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
    READING_NONE,  /* no burst ended since the last call */
    READING_GOOD,  /* a sample */
    READING_EMPTY, /* the sensor had none */
    READING_BAD,   /* torn, shifted, or no device */
    READING_RESET, /* registers as after power-on: the sensor has lost its configuration */
    READING_FAILED /* the transfer failed */
} reading_t;

/* From here on readings use this configuration's range and self-test; the first one has no predecessor. */
void adxl345_integrity_start(const adxl345_config_t *config);

/* The sensor may be a different one: clears the run of repeats and INT1 stuck. */
void adxl345_integrity_forget(void);

/*
 * The verdict on a reading, which is also counted. lsb: its data, x, y, z as in adxl345_sample_t, valid if GOOD;
 * last_lsb: those of the last GOOD one.
 */
reading_t adxl345_integrity_judge(const uint8_t reading[READING_BYTES], int16_t lsb[3], const int16_t last_lsb[3]);

/* A reading was EMPTY although INT1 was high. */
void adxl345_integrity_int1_lied(void);

/*
 * The newest good reading is at least the tenth in a row that is equal on all axes.
 *
 * Noise at rest does that with a probability of sum over k of p(k)^10 for each axis, where p(k) is the probability of
 * code k; it is largest if the true value is a whole code. The lowest noise is that at 100 Hz and below: 0.75, 0.75 and
 * 1.1 LSB rms (data sheet, p. 4 and 33; at every range, because full resolution keeps the LSB), which gives 2.3e-11 per
 * sample, and 6.0e-11 with that of the quietest recording (0.72, 0.78, 0.99). The probability of two equal ones, 0.036,
 * to the seventh power is 8e-11 too, but repeats are not independent: once a code is the likeliest one it stays so, and
 * eight equal ones have 3.3e-9.
 */
#define ADXL345_STUCK_REPEATS 9u
bool adxl345_integrity_stuck(void);

/* Why the sensor must be configured again: ADXL345_FAULT_NO_DATA, ADXL345_FAULT_TORN, or NONE. */
adxl345_fault_t adxl345_integrity_fault(void);

/*
 * INT1 was high without a sample three times, with no good reading in between that left it low. Lasts until 32 good
 * readings have left INT1 low.
 */
bool adxl345_integrity_int1_stuck(void);

#endif
