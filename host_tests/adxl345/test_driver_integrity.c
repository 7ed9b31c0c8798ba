/*
 * What a burst brings is a reading of this sensor, or nothing goes out: supply lost, bits that slip, wires off in every
 * byte, a sensor that has forgotten its configuration.
 */
#include "adxl345.h"
#include "adxl345_burst.h"
#include "adxl345_integrity.h"
#include "adxl345_registers.h"
#include "hal_host.h"
#include "hal_time.h"
#include "support/rig.h"
#include "support/test.h"

enum { STARTED_MS = 100, PATTERN = 0x8A };

static const adxl345_config_t at_100_hz = { 1000, 16, false, 0 };
static uint8_t marks;

/* An alteration of what arrives: from byte `from` on of the burst, for so many bursts. */
typedef enum { NOTHING, POWER_OFF, ZEROS, ONES, LATE_BITS, EARLY_BITS, FLIP, FORGOT } change_t;
static change_t change;
static unsigned from;
static unsigned bits; /* by which it is late or early; or the bits that flip */
static bool level;    /* of SDA while the sensor did not drive it */
static unsigned bursts_left;
static uint8_t before;
static unsigned next_byte; /* of the burst under way */
static bool ready;         /* its INT_SOURCE came in with a sample ready: else it ends with the byte after */
static bool forgotten;     /* it reads as after power-on: the sensor is configured again, which clears its FIFO */

/* So many bits late: they have the level of the line, and push the others back. */
static uint8_t late(unsigned at, uint8_t byte)
{
    unsigned carry = at == from ? (level ? 0xFFu : 0u) : before;
    before = byte;
    return (uint8_t)(carry << (8u - bits) | (unsigned)byte >> bits);
}

/* So many bits were clocked out before the master looked. */
static uint8_t early(uint8_t reg, uint8_t byte)
{
    unsigned next = hal_host_sensor()->reg[(reg + 1u) & 0x3Fu];
    return (uint8_t)((unsigned)byte << bits | next >> (8u - bits));
}

static uint8_t altered(unsigned at, uint8_t reg, uint8_t byte)
{
    if (at < from) {
        return byte;
    }
    switch (change) {
    case POWER_OFF: /* this byte is the last one */
        adxl345_model_power(hal_host_sensor(), false);
        bursts_left = 0;
        return byte;
    case ZEROS:
        return 0;
    case ONES:
        return 0xFF;
    case LATE_BITS:
        return late(at, byte);
    case EARLY_BITS:
        return early(reg, byte);
    case FLIP:
        return at == from ? (uint8_t)(byte ^ bits) : byte;
    case FORGOT: /* as after power-on */
        return at == READING_SOURCE ? ADXL345_INT_WATERMARK : 0;
    default:
        return byte;
    }
}

/* What has arrived of a burst says whether it goes on, and whether the sensor seems to have forgotten its settings. */
static void note(unsigned at, uint8_t arrives)
{
    if (at == READING_SOURCE) {
        ready = (arrives & ADXL345_INT_DATA_READY) != 0;
        forgotten = !ready && (arrives & ADXL345_INT_WATERMARK) != 0;
    } else if (at == READING_FORMAT) {
        forgotten = forgotten && arrives == 0;
    }
    if (bursts_left != 0 && at == (ready ? READING_BYTES - 1u : (unsigned)READING_FORMAT)) {
        bursts_left--;
    }
}

static uint8_t on_rx(uint8_t reg, uint8_t byte)
{
    unsigned at = (unsigned)reg - ADXL345_INT_SOURCE;
    next_byte = reg == ADXL345_INT_SOURCE ? 0 : next_byte;
    if (bursts_left == 0 || at != next_byte) {
        return byte;
    }
    next_byte++;
    uint8_t arrives = altered(at, reg, byte);
    note(at, arrives);
    return arrives;
}

static void pass(void)
{
    rig_pass();
    marks |= adxl345_marks();
}

void setUp(void)
{
    marks = 0;
    bursts_left = 0;
    rig_begin(100.0, (hal_host_config_t){ .on_rx = on_rx });
    rig.pass = pass;
}

static void start_and_change(change_t what, unsigned at, unsigned by, unsigned bursts)
{
    setUp();
    adxl345_start(&at_100_hz);
    rig_run_ms(STARTED_MS);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    (void)adxl345_marks();
    marks = 0;
    change = what;
    from = at;
    bits = by;
    bursts_left = bursts;
}

static uint16_t failed(void)
{
    adxl345_readings_t readings;
    adxl345_readings(&readings);
    return readings.failed;
}

/* One burst goes wrong from a byte on: no sample of it comes out, and the sensor goes on as if nothing were. */
TEST(test_a_burst_that_goes_wrong_at_any_byte_brings_nothing)
{
    static const change_t changes[] = { ZEROS, ONES };
    for (unsigned c = 0; c < 2; c++) {
        for (unsigned at = 0; at <= READING_FIFO_CTL; at++) {
            start_and_change(changes[c], at, 0, 1);
            uint16_t before_it = failed();
            rig_run_ms(60);
            TEST_ASSERT_EQUAL_UINT16(before_it + 1, failed());
            TEST_ASSERT_EQUAL_HEX8(ADXL345_MARK_INTEGRITY, marks);
            rig_run_ms(60);
            TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
            TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
            TEST_ASSERT_EQUAL_size_t(ready ? 1 : 0, rig_lost(60)); /* its data were read, or stayed in the sensor */
        }
    }
    start_and_change(ONES, READING_FIFO_STATUS, 0, 1); /* the data were right, but who knows */
    rig_run_ms(60);
    TEST_ASSERT_EQUAL_size_t(1, rig_lost(60));
}

TEST(test_supply_lost_at_any_byte_brings_nothing_wrong)
{
    for (unsigned at = 0; at < READING_BYTES; at++) {
        start_and_change(POWER_OFF, at, 0, 1);
        rig_run_ms(100);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NO_SENSOR, adxl345_fault());
        adxl345_model_power(hal_host_sensor(), true);
        rig_run_ms(150);
        TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
    }
}

/* A bit more or less than the master clocked, in either level of the line, from any byte on. */
TEST(test_bits_that_slip_at_any_byte_bring_nothing)
{
    for (unsigned at = 0; at <= READING_FIFO_CTL; at++) {
        for (unsigned by = 1; by < 8; by++) {
            for (unsigned way = 0; way < 3; way++) {
                start_and_change(way == 2 ? EARLY_BITS : LATE_BITS, at, by, 1);
                level = way == 1;
                rig_run_ms(100);
                TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
                TEST_ASSERT_EQUAL_HEX8(ADXL345_MARK_INTEGRITY, marks);
                TEST_ASSERT_EQUAL_size_t(ready || forgotten ? 1 : 0, rig_lost(60));
            }
        }
    }
}

/* Two torn readings in a row are read over; the third is a fault with a name, and the sensor is configured anew. */
TEST(test_three_torn_readings_in_a_row_are_a_fault)
{
    for (unsigned torn = 1; torn <= 4; torn++) {
        start_and_change(FLIP, READING_FIFO_CTL, 0x40, torn);
        unsigned told = 0;
        for (double end_ms = hal_host_now_ms() + 150.0; hal_host_now_ms() < end_ms;) {
            pass();
            adxl345_fault_t fault = adxl345_fault();
            TEST_ASSERT_TRUE(fault == ADXL345_FAULT_NONE || fault == ADXL345_FAULT_TORN);
            told += fault == ADXL345_FAULT_TORN;
        }
        TEST_ASSERT_EQUAL(torn >= 3, told != 0);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
        TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
        TEST_ASSERT_EQUAL_HEX8(PATTERN, hal_host_sensor()->reg[ADXL345_FIFO_CTL]);
        /* configured anew within 3 ms, turned on for 11.1 ms, and no samples meanwhile but those of the fault */
        TEST_ASSERT_EQUAL_size_t(torn, rig_lost(60));
    }
}

/* Torn readings with good ones in between are not in a row. */
TEST(test_torn_readings_apart_are_no_fault)
{
    start_and_change(FLIP, READING_FIFO_CTL, 0x40, 0);
    for (unsigned i = 0; i < 10; i++) {
        bursts_left = 1;
        rig_run_ms(20);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
    }
    TEST_ASSERT_EQUAL_size_t(10, rig_lost(60));
}

/* Registers as after power-on: no silence is awaited, no pause made. 21 accesses of under 0.2 ms, then the turn-on. */
TEST(test_a_sensor_that_forgot_is_configured_at_once)
{
    start_and_change(FORGOT, 0, 0, 1);
    while (adxl345_fault() == ADXL345_FAULT_NONE) {
        pass();
    }
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NO_DATA, adxl345_fault());
    TEST_ASSERT_EQUAL(ADXL345_STARTING, adxl345_phase());
    double begun_ms = hal_host_now_ms();
    while (adxl345_fault() != ADXL345_FAULT_NONE) {
        pass();
    }
    TEST_ASSERT_TRUE(hal_host_now_ms() - begun_ms < 4.2 + 10.0 + 1.1 + 0.5);
}

/* A stop that comes with it stops. */
TEST(test_a_stop_while_readings_fail_stops)
{
    for (unsigned b = 1; b < 4; b++) {
        start_and_change(b == 1 ? FORGOT : FLIP, b == 1 ? 0 : READING_FIFO_CTL, 0x40, b);
        for (double end_ms = hal_host_now_ms() + 40; bursts_left != 0 && hal_host_now_ms() < end_ms;) {
            pass();
        }
        adxl345_stop();
        rig_run_ms(120);
        TEST_ASSERT_EQUAL(ADXL345_STOPPED, adxl345_phase());
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
    }
}

/* A bit of the running sensor's DATA_FORMAT flips: self-test, resolution, range, justification are not as they were. */
TEST(test_a_sensor_whose_format_changes_is_configured_anew)
{
    for (unsigned bit = 0; bit < 8; bit++) {
        start_and_change(NOTHING, 0, 0, 0);
        hal_host_sensor()->reg[ADXL345_DATA_FORMAT] ^= (uint8_t)(1u << bit);
        size_t taken = rig.taken_count;
        while (adxl345_fault() == ADXL345_FAULT_NONE) {
            pass();
        }
        TEST_ASSERT_TRUE(rig.taken_count <= taken + 1); /* one may have been on its way */
        rig_run_ms(60);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
        TEST_ASSERT_EQUAL_HEX8(0x0B, hal_host_sensor()->reg[ADXL345_DATA_FORMAT]);
    }
}

/*
 * Two readings were torn and a third is, and is judged as a poll does it; then the next sample begins a burst before
 * the poll looks at the three. The fault finds it on the bus; main stops or starts anew before it has looked: its
 * sample comes all the same if it is whole by then.
 */
TEST(test_a_burst_that_ended_well_when_the_bus_is_taken_is_delivered)
{
    unsigned ended = 0;
    for (unsigned phase = 0; phase < 60; phase++) {
        start_and_change(FLIP, READING_FIFO_CTL, 0x40, 3);
        while (bursts_left > 1 || adxl345_burst_running()) {
            pass();
        }
        rig_until_burst();
        while (adxl345_burst_bus_state() == I2C_BUS_BUSY) {
            rig_away(1);
        }
        TEST_ASSERT_EQUAL(READING_BAD, adxl345_burst_judge());
        while (!adxl345_burst_running()) {
            rig_away(1);
        }
        adxl345_poll(hal_time_us());
        TEST_ASSERT_EQUAL(ADXL345_FAULT_TORN, adxl345_fault());
        rig_away(phase / 2);
        bool whole = adxl345_burst_bus_state() == I2C_BUS_OK;
        ended += whole;
        if ((phase & 1u) != 0) {
            adxl345_start(&at_100_hz);
        } else {
            adxl345_stop();
        }
        TEST_ASSERT_EQUAL_UINT8(whole, adxl345_queued());
        TEST_ASSERT_EQUAL_UINT8(!whole, adxl345_burst_failures());
        rig_take_all();
        TEST_ASSERT_TRUE(!whole || rig.taken_count == rig.latched_count - 3);
        rig_run_ms(60);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
    }
    TEST_ASSERT_TRUE(ended > 10 && ended < 50);
}
