/* Private state of adxl345_burst.c; volatile where its handlers share it with main. */
#ifndef ADXL345_BURST_STATE_H
#define ADXL345_BURST_STATE_H

#include "adxl345_burst.h"

struct burst {
    i2c_bus_t bus;         /* rx: the reading of a burst, indexed by READING_*; a register's value is its first byte */
    volatile uint8_t head; /* head and tail wrap at 256: the lower bits are the index in the queue */
    volatile uint8_t tail;
    volatile uint8_t mode;
    volatile uint8_t on_bus; /* a burst that main has not judged: running or ended */
    volatile uint8_t edge_waiting;
    volatile uint32_t edge_us;
    volatile uint32_t begun_us; /* start of the newest burst */
    volatile uint8_t by_edge;   /* it was started by the edge of its own sample */
    uint8_t failures;
    uint8_t failed_state;                      /* i2c_bus_state_t of the newest failed burst */
    uint32_t last_us;                          /* stamp of the newest sample that left the sensor, delivered or cut */
    bool last_known;                           /* last_us belongs to this run of the sensor */
    uint8_t int1;                              /* adxl345_fault_t of INT1: why main started it and no edge came */
    uint8_t verdict;                           /* reading_t of the newest burst that did not fail on the bus */
    burst_entry_t queue[ADXL345_QUEUE_LENGTH]; /* the entry at head has the stamp of the sample being read */
};

#endif
