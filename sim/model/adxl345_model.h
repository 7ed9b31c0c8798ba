/*
 * A virtual ADXL345 at register level, in pure C: no simulator types, no clock of its own. Its owner calls
 * adxl345_model_tick once per output-data-rate period and passes the bus events in; the model answers with ACKs, bytes
 * and the levels of INT1 and INT2. Used under simavr (sim/run/simrun_sensor.c) and natively (hal/host). Source: ADXL345
 * data sheet Rev. E; facts with pages in docs/wiring.md.
 */
#ifndef ADXL345_MODEL_H
#define ADXL345_MODEL_H

#include <stdbool.h>
#include <stdint.h>

#include "adxl345_variants.h"

#define ADXL345_MODEL_FIFO_DEPTH 33 /* 32 in the FIFO and one in the output filter (p. 27) */

/*
 * Differences between parts, each for x, y, z. Data sheet p. 4: gain 230..282 of 256 LSB/g (a tenth to each side),
 * offsets of up to 38 LSB (x, y) and 64 LSB (z); p. 5: self-test.
 */
typedef struct {
    double gain[3];           /* 1: 256 LSB/g */
    int16_t offset_lsb[3];    /* reading at 0 g, full resolution */
    int16_t self_test_lsb[3]; /* shift by SELF_TEST, full resolution */
} adxl345_part_t;

/* Exact gain, no offset, the self-test shift that is typical at 3.3 V. */
extern const adxl345_part_t adxl345_part_typical;

typedef struct adxl345_model {
    /* wiring and options, set by the owner after adxl345_model_init */
    uint8_t address;                                           /* 7 bit: 0x53, or 0x1D with ALT ADDRESS high */
    uint8_t device_id;                                         /* what DEVID holds after the next power-on; 0xE5 */
    const adxl345_variant_t *variant;                          /* adxl345_model_become */
    void (*pin_changed)(void *owner, unsigned pin, bool high); /* pin 1 or 2; may be NULL */
    /* latched: a triplet became readable (reached the data registers or FIFO); value as the registers show it */
    void (*latched)(void *owner, const int16_t lsb[3]); /* may be NULL */
    void *owner;
    bool shadowing; /* true: a burst of the data registers is never torn (p. 21) */
    adxl345_part_t part;

    /* state: tests may read it; change it only through the functions below */
    uint8_t reg[64];
    uint8_t pointer; /* kept across a STOP */
    bool powered;
    bool selected, reading, pointer_written, data_touched;
    int16_t fifo[ADXL345_MODEL_FIFO_DEPTH][3]; /* fifo[0] is what DATAX0.. show */
    uint8_t fifo_count;
    int16_t pending[3]; /* arrived inside a burst (shadowing) */
    bool has_pending;
    bool data_ready, overrun, triggered; /* data_ready: bypass mode only, otherwise fifo_count != 0 */
    uint8_t events;                      /* INT_SOURCE bits 6..2, latched until INT_SOURCE is read */
    bool pin_high[3];                    /* index 1, 2 */
    uint32_t ticks_in_measure;           /* since Measure was set: first data after the turn-on time */

    /* counters, to check the firmware's own against */
    uint32_t samples, overruns, torn, data_reads, writes_while_measuring;
} adxl345_model_t;

/* Powered, registers at their reset values, address 0x53, shadowing on, no callbacks; the typical part. */
void adxl345_model_init(adxl345_model_t *m);

/* Replaces the sensor by this variant, just powered: its identity, scale and self-test; the other options are kept. */
void adxl345_model_become(adxl345_model_t *m, const adxl345_variant_t *variant);

/*
 * Power off (no ACK, pins low) and on (registers at reset, FIFO empty, pointer 0). An MCU reset does not affect the
 * sensor.
 */
void adxl345_model_power(adxl345_model_t *m, bool on);

/*
 * The sensor has detected a tap, activity, inactivity or free fall: these INT_SOURCE bits (6..2, others are ignored)
 * are latched until INT_SOURCE is read. The model does not compute them from the acceleration.
 */
void adxl345_model_event(adxl345_model_t *m, uint8_t source_bits);

/* Bus events. start: address byte after a START or repeated START (bit 0 = read); returns ACK. */
bool adxl345_model_start(adxl345_model_t *m, uint8_t address_byte);
bool adxl345_model_write(adxl345_model_t *m, uint8_t byte); /* returns ACK */
uint8_t adxl345_model_read(adxl345_model_t *m);
void adxl345_model_stop(adxl345_model_t *m);

/*
 * Output data rate from BW_RATE in Hz, 0.1..3200; 0 when not measuring (standby, no power, or sleep, which suppresses
 * DATA_READY and sends nothing to the FIFO, p. 25).
 */
double adxl345_model_odr_hz(const adxl345_model_t *m);

/*
 * One output-data-rate period has passed and the acceleration is `full` (full-resolution LSB at +-16 g, 256 LSB/g).
 * Applies the variant's scale, the part's gain and offset, self-test shift, offset registers, range, resolution,
 * justification and rails, then stores into the data registers or the FIFO according to its mode. Returns false when
 * not measuring (nothing stored).
 * Turn-on: the owner makes the first tick one period and 1.1 ms after Measure was set (p. 5), the others one period
 * apart.
 */
bool adxl345_model_tick(adxl345_model_t *m, const int16_t full[3]);

/* The range in force, for data in full resolution or 10 bits. */
double adxl345_model_range_g(const adxl345_model_t *m);

/* The same conversion without storing: what the registers would show for this acceleration. */
void adxl345_model_convert(const adxl345_model_t *m, const int16_t full[3], int16_t lsb[3]);

#endif
