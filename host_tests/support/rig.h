/*
 * The ADXL345 driver alone over the host's HAL, for tests (with Unity): a sensor whose samples tell which one they are,
 * the book of when each was latched, and a main that takes them and holds them against it.
 */
#ifndef SUPPORT_RIG_H
#define SUPPORT_RIG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "adxl345.h"
#include "hal_host.h"

typedef struct {
    stream_t stream;      /* x counts, so that every sample tells which one it is; y is -100, z 250 LSB */
    size_t latched_count; /* samples the sensor took, since rig_begin */
    size_t taken_count;   /* samples that main took */
    size_t next;          /* the first of the latched samples that main may still take */
    int last_x;           /* of the sample taken last */
    uint32_t off_us;      /* the most that a stamp was from the moment when its sample was latched */
    uint32_t limit_us;    /* the most that it may be; begins as 100 */
    bool leaves;          /* main leaves in the queue what is there */
    void (*pass)(void);   /* one pass of main; begins as rig_pass */
} rig_t;

extern rig_t rig;

/* Power on of sensor (rate of its rows in Hz) and board, and what the firmware begins; the book is begun anew. */
void rig_begin(double rate_hz, hal_host_config_t config);

/* What the firmware begins after any reset: line, clock, INT1, driver. */
void rig_reset(void);

/*
 * Takes what the driver has. Each is one that the sensor held, later than the one before it, with its own time (within
 * limit_us), or the test fails.
 */
void rig_take_all(void);

/* One pass of main: poll, take all, sleep. */
void rig_pass(void);

/* Passes for so many virtual milliseconds. */
void rig_run_ms(double ms);

/* Starts with this configuration, passes for so many milliseconds; it streams at their end, or the test fails. */
void rig_stream_ms(const adxl345_config_t *config, double ms);

/* Stops, which must have come about after so many milliseconds; how many of the latched samples did not come out. */
size_t rig_lost(double ms);

/* So many times 20 us of the bus, without a poll. */
void rig_away(unsigned passes);

/* Polls every 20 us, takes nothing, until a burst runs. */
void rig_until_burst(void);

/* No burst runs and none is due for a while: the next event is the START of the next sample. */
void rig_until_pause(void);

/* So many edges on D2 within one pass of main. */
void rig_edges(unsigned count);

/* Passes until so many samples have been taken; a second at most. */
void rig_until_taken(size_t count);

/* INT1 is cut; passes until a burst that asks the sensor all the same has just been put on the bus. */
void rig_until_asked(void);

#endif
