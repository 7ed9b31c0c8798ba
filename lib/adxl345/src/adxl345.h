/*
 * ADXL345 driver: a non-blocking state machine.
 *
 *   stopped -> probe (0x53, then 0x1D) -> configure in standby -> read back -> streaming
 *                ^------------------- fault (named, retried with back-off) <-----'
 *
 * While streaming, the data-ready interrupt stamps the time and starts one burst; the I2C interrupt moves its bytes
 * into a queue; main takes samples out. Samples that a late read left in the sensor's FIFO (stream mode, 32 deep) are
 * drained from main with interpolated stamps. One sensor, one instance: the interrupts share its state.
 *
 * Contexts: every function here is for main. The two handlers are in adxl345_burst.c.
 */
#ifndef ADXL345_H
#define ADXL345_H

#include <stdbool.h>
#include <stdint.h>

#define ADXL345_QUEUE_LENGTH 8u /* power of two; one slot stays free */

typedef struct {
    uint32_t t_us;  /* of data-ready (hal_time_us); interpolated for samples drained from the FIFO */
    int16_t lsb[3]; /* x, y, z; full resolution, 256 LSB/g nominal */
} adxl345_sample_t;

typedef struct {
    uint16_t rate_dhz; /* output data rate in 0.1 Hz: 125, 250, 500, 1000, 2000, 4000, 8000 */
    uint8_t range_g;   /* 2, 4, 8, 16; always full resolution */
    bool self_test;    /* the sensor's electrostatic force acts on all axes: readings are offset (p. 22) */
    uint8_t address;   /* 7 bits: 0x53 or 0x1D, only that one is probed; 0: both */
} adxl345_config_t;

/* What is wrong, in the order in which the driver finds it. Numbers are part of the protocol (docs/protocol.md). */
typedef enum {
    ADXL345_FAULT_NONE = 0,
    ADXL345_FAULT_NO_SENSOR = 1,     /* no ACK at 0x53 nor at 0x1D */
    ADXL345_FAULT_WRONG_ID = 2,      /* a device answers, but DEVID is not 0xE5 */
    ADXL345_FAULT_BUS = 3,           /* a transfer did not end in time on free lines, bus error, arbitration lost */
    ADXL345_FAULT_READ_BACK = 4,     /* a register does not hold what was written */
    ADXL345_FAULT_INT1_SILENT = 5,   /* data are ready in the sensor, but INT1 does not rise */
    ADXL345_FAULT_NO_DATA = 6,       /* the sensor answers but has stopped measuring: it lost power or its registers */
    ADXL345_FAULT_SCL_LOW = 7,       /* SCL is held low */
    ADXL345_FAULT_SDA_LOW = 8,       /* SDA is held low, and 16 clocks have not freed it */
    ADXL345_FAULT_INT1_STUCK = 9,    /* INT1 stays high without data */
    ADXL345_FAULT_STUCK = 10,        /* the same values over and over */
    ADXL345_FAULT_TORN = 11,         /* three readings in a row did not come from this sensor */
    ADXL345_FAULT_TWO_SENSORS = 12,  /* an axis jumps between a value and its double: two sensors on one address */
    ADXL345_FAULT_INT1_FLICKERS = 13 /* more edges than samples: nothing drives D2 */
} adxl345_fault_t;

typedef enum {
    ADXL345_STOPPED,
    ADXL345_STARTING, /* probe, configure, read back, wait for the first sample */
    ADXL345_STREAMING,
    ADXL345_QUIESCING, /* new configuration requested: standby, FIFO drained, then STARTING */
    ADXL345_FAULTY     /* waiting for the next attempt */
} adxl345_phase_t;

/* True for rates and ranges that the chip and the bus support (data sheet p. 18: 800 Hz needs 400 kHz). */
bool adxl345_config_valid(const adxl345_config_t *config);

/* Call once, before interrupts are on: everything stopped, nothing on the bus yet. */
void adxl345_init(void);

/* Starts, or restarts with another configuration: samples already latched by the sensor are delivered first. */
void adxl345_start(const adxl345_config_t *config);

/*
 * SCL from the next start on: 363.6 or 100 kHz. FALLS_BACK begins with 363.6 and changes to the other after sixteen
 * faults that slow or noisy wires cause (WRONG_ID with ones missing, BUS, READ_BACK, TORN), and back after sixteen
 * more. Setting the same speed again changes nothing. The sensor takes 100 kHz up to 200 Hz (p. 18): 400 Hz always has
 * 363.6, 800 Hz always 400 kHz.
 */
typedef enum { ADXL345_I2C_FALLS_BACK = 0, ADXL345_I2C_364_KHZ = 32, ADXL345_I2C_100_KHZ = 48 } adxl345_i2c_t;
void adxl345_set_i2c(adxl345_i2c_t speed);

/* SCL's period at this output data rate, in 0.25 us; whether faults have made it slow, which shows up to 200 Hz. */
uint8_t adxl345_scl_025us(uint16_t rate_dhz);
bool adxl345_i2c_fell_back(void);

/* Standby, after the samples already latched have been delivered. */
void adxl345_stop(void);

/* Advances the state machine by at most one step. Call after every wake-up; never waits. */
void adxl345_poll(uint32_t now_us);

/*
 * Takes the oldest sample out of the queue; NULL if it is empty. Frees its slot, so that a waiting FIFO entry can be
 * read. The sample stays valid until the next adxl345_poll, _start or _stop.
 */
const adxl345_sample_t *adxl345_take(void);

/* Samples waiting in the queue. */
uint8_t adxl345_queued(void);

/* Time of the oldest sample in the queue; false if it is empty. */
bool adxl345_oldest_us(uint32_t *t_us);

/*
 * A sample waits in the sensor: INT1 is high and trusted. It is not if the newest read found no sample and no edge has
 * come since.
 */
bool adxl345_sample_waits(void);

adxl345_phase_t adxl345_phase(void);

/*
 * A fault while ADXL345_STREAMING means that samples continue, but there is something wrong with them or their timing.
 */
adxl345_fault_t adxl345_fault(void);

/* The sensor is being probed and configured again because it failed; that need not be a fault yet. Main. */
bool adxl345_interrupted(void);

/*
 * The time by which adxl345_poll must run; main passes it to hal_wake_at before it sleeps. A poll later than this means
 * that main is stuck. In the past and meaningless while the driver is stopped.
 */
uint32_t adxl345_deadline_us(void);

/* 7-bit address at which an ADXL345 was found last; 0x53 before the first. */
uint8_t adxl345_address(void);

/* The device that ADXL345_FAULT_WRONG_ID refers to, as it was when the fault was found: its address and its DEVID. */
uint8_t adxl345_foreign_address(void);
uint8_t adxl345_foreign_id(void);

/* Measured time between samples, us (nominal until measured), by the board's clock. */
uint32_t adxl345_period_us(void);

/* The same as output data rate, 0.01 Hz, from 16 samples in a row that were read in time; 0 until then. Divides. */
uint32_t adxl345_rate_chz(void);

/* Counters, saturating. Each failed transfer is in one of the last four, whether its sample was lost or not. */
typedef struct {
    uint16_t samples_drained;   /* read late, with an interpolated stamp */
    uint16_t samples_stuck;     /* see ADXL345_MARK_STUCK */
    uint16_t restarts;          /* sensor configured again after a fault */
    uint16_t nacks;             /* address or data not acknowledged */
    uint16_t arbitrations_lost; /* noise, or another master */
    uint16_t bus_errors;        /* START or STOP out of place, or an impossible status */
    uint16_t timeouts;          /* did not end, or not begin, in time */
} adxl345_counters_t;
void adxl345_counters(adxl345_counters_t *out);

/* Readings that were not new samples, saturating. None of them was delivered. And what INT1 did. */
typedef struct {
    uint16_t failed;   /* torn, shifted, or no device */
    uint16_t empty;    /* INT1 was high, but the sensor had no new sample */
    uint16_t overruns; /* readings from a FIFO that had filled up: samples were lost */
    uint16_t storms;   /* times that ADXL345_FAULT_INT1_FLICKERS began */
} adxl345_readings_t;
void adxl345_readings(adxl345_readings_t *out);

/* One of these counters by index: first those of adxl345_counters_t, then those of adxl345_readings_t. */
uint16_t adxl345_count(uint8_t at);

/* ADXL345_MARK_* since the last call: the bits of the row's flags that come from the driver (docs/protocol.md). */
enum { ADXL345_MARK_STUCK = 32, ADXL345_MARK_INTEGRITY = 64 };
uint8_t adxl345_marks(void);

#endif
