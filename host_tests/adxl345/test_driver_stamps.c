/*
 * The times of samples that are read late, where a bound decides: how long the sensor can hold one, how late an edge
 * may be, what a cut or an empty reading proves of the sample that follows.
 */
#include "adxl345.h"
#include "adxl345_burst.h"
#include "adxl345_registers.h"
#include "hal_drdy.h"
#include "hal_host.h"
#include "hal_i2c.h"
#include "hal_time.h"
#include "support/board.h"
#include "support/documented_limits.h"
#include "support/rig.h"
#include "support/test.h"

enum { PERIOD_US = 10000, PASSES_PER_PERIOD = PERIOD_US / 20, BURST_US = 500, EXACT_US = 100 };
enum { FIFO_FULL = 32, DEPTH = LIMIT_SENSOR_DEPTH }; /* samples in the FIFO, and in the sensor (data sheet p. 27) */
/* START, address, register, START, address, INT_SOURCE, DATA_FORMAT, data */
enum { ADDRESS_EVENT = 1, FIRST_DATA_EVENT = 7 };

static const adxl345_config_t at_100_hz = { 1000, 16, false, 0 };

void hal_host_drdy_handler(void);

static bool sample_as_main_claims; /* the sensor takes its next sample while main claims the bus */

static unsigned torn_left; /* readings that arrive with a wrong FIFO_CTL */

static uint8_t tear(uint8_t reg, uint8_t byte)
{
    bool torn = reg == ADXL345_FIFO_CTL && torn_left != 0;
    torn_left -= torn;
    return torn ? UINT8_MAX : byte;
}

static void on_stop_asked(void)
{
    if (sample_as_main_claims) {
        sample_as_main_claims = false;
        TEST_ASSERT_TRUE(adxl345_model_tick(hal_host_sensor(), rig.stream.rows[3000].lsb));
    }
}

static void begin(double ppm)
{
    torn_left = 0;
    sample_as_main_claims = false;
    rig_begin(1e6 / PERIOD_US,
              (hal_host_config_t){
                  .time_start_us = 0xFFFFFFFFu - 250000u, .ppm = ppm, .on_rx = tear, .on_stop_asked = on_stop_asked });
}

void setUp(void)
{
    begin(0.0);
}

static void stream_for_ms(double ms)
{
    rig_stream_ms(&at_100_hz, ms);
    rig_until_pause();
}

/* Main does not look until the sensor holds so many samples. */
static void away_until_held(unsigned samples)
{
    for (unsigned left = 2 * DEPTH * PASSES_PER_PERIOD; hal_host_sensor()->fifo_count < samples; left--) {
        TEST_ASSERT_TRUE_MESSAGE(left != 0, "the sensor never held so many");
        rig_away(1);
    }
}

static void pass_until_taken(size_t count)
{
    for (double end_ms = hal_host_now_ms() + 60.0; rig.taken_count < count;) {
        TEST_ASSERT_TRUE_MESSAGE(hal_host_now_ms() < end_ms, "the sample never came");
        rig_pass();
    }
}

/* Stamp of the sample that comes next, not taken yet. */
static uint32_t next_stamp_us(void)
{
    uint32_t t_us = 0;
    for (unsigned left = 2 * PASSES_PER_PERIOD; !adxl345_oldest_us(&t_us); left--) {
        TEST_ASSERT_TRUE_MESSAGE(left != 0, "the sample never came");
        (void)adxl345_burst_judge();
        rig_away(1);
    }
    return t_us;
}

/*
 * The sensor pauses, then has one sample without an edge. It is the next after the last one, if it may have waited
 * for so long: the 33rd after it pushes it out, so 33 periods are the most.
 */
TEST(test_no_sample_waits_longer_than_the_sensor_is_deep)
{
    for (unsigned periods = 2; periods < 2 * DEPTH + 4; periods++) {
        setUp();
        stream_for_ms(300);
        uint32_t last_us = next_stamp_us();
        rig_take_all();
        hal_host_faults()->int1_cut = true;
        hal_host_sensor()->reg[ADXL345_POWER_CTL] = 0;
        rig_away(periods * PASSES_PER_PERIOD);
        hal_host_sensor()->reg[ADXL345_POWER_CTL] = ADXL345_POWER_MEASURE;
        TEST_ASSERT_TRUE(adxl345_model_tick(hal_host_sensor(), rig.stream.rows[3000].lsb));
        uint32_t now_us = hal_time_us();
        adxl345_burst_read();
        TEST_ASSERT_TRUE(adxl345_burst_running());
        uint32_t waited_us = now_us - (last_us + PERIOD_US);
        TEST_ASSERT_UINT32_WITHIN(BURST_US, (periods - 1) * PERIOD_US, waited_us);
        bool may_be = waited_us <= DEPTH * PERIOD_US;
        TEST_ASSERT_EQUAL(periods <= DEPTH, may_be);
        TEST_ASSERT_UINT32_WITHIN(EXACT_US, may_be ? last_us + PERIOD_US : now_us - DEPTH * PERIOD_US, next_stamp_us());
    }
}

/*
 * Main is away until the sensor has lost samples, and then its first readings are torn: those after them have no edge
 * and no Overrun bit. How many were lost is not known, but none can have waited longer than the sensor is deep.
 */
TEST(test_torn_readings_of_a_full_sensor_do_not_make_the_others_late)
{
    for (unsigned torn = 1; torn <= 2; torn++) {
        for (unsigned phase = 0; phase < 10; phase++) {
            setUp();
            stream_for_ms(300);
            hal_host_faults()->int1_cut = true;
            rig_away((DEPTH + 5) * PASSES_PER_PERIOD + phase * PASSES_PER_PERIOD / 10u);
            size_t lost = hal_host_sensor()->overruns;
            TEST_ASSERT_TRUE(lost > 0);
            torn_left = torn;
            rig.limit_us = PERIOD_US + BURST_US;
            rig_run_ms(100);
            TEST_ASSERT_EQUAL_UINT(0, torn_left);
            TEST_ASSERT_EQUAL_size_t(lost + torn, rig_lost(60));
        }
    }
}

/*
 * The first sample of a sensor whose clock is 4 % fast: its burst is refused, or cut in the last byte before the data,
 * and main comes late, with up to 30 after it (a FIFO of 32 has filled, and says Overrun). By the nominal period it
 * seems 30 x 4 % + 1/2 = 1.7 periods too late for them: it keeps the time of its edge.
 */
TEST(test_an_edge_counts_more_than_a_nominal_period)
{
    for (unsigned i = 0; i < 2 * (FIFO_FULL - 1); i++) {
        unsigned held = i / 2 + 1;
        bool refused = i % 2 == 0;
        begin(40000.0);
        rig.limit_us = UINT32_MAX; /* those after it have the nominal period */
        adxl345_start(&at_100_hz);
        rig_run_ms(5); /* configured, and the STOP is out */
        TEST_ASSERT_EQUAL_HEX8(ADXL345_POWER_MEASURE, hal_host_sensor()->reg[ADXL345_POWER_CTL]);
        TEST_ASSERT_EQUAL_size_t(0, rig.latched_count);
        hal_host_faults()->status_skip = refused ? ADDRESS_EVENT : FIRST_DATA_EVENT - 1;
        hal_host_faults()->next_status = refused ? HAL_I2C_WRITE_ADDRESS_NACK : HAL_I2C_BUS_ERROR;
        away_until_held(held);
        pass_until_taken(1);
        TEST_ASSERT_EQUAL(-1, hal_host_faults()->next_status);
        TEST_ASSERT_TRUE_MESSAGE(rig.off_us <= EXACT_US, "the time of its edge was not kept");
    }
}

/*
 * INT1 comes back to a sensor that holds so many samples: its edge is late for the oldest, by more than two periods
 * from three on. What follows it gives its age, but for the half period that the newest may be old, and the burst.
 */
TEST(test_the_edge_of_int1_that_comes_back_is_not_the_samples)
{
    for (unsigned held = 3; held <= DEPTH; held++) {
        for (unsigned phase = 0; phase < 10; phase++) {
            setUp();
            rig.limit_us = PERIOD_US / 2 + BURST_US;
            stream_for_ms(300);
            hal_host_faults()->int1_cut = true;
            away_until_held(held);
            rig_away(phase * PASSES_PER_PERIOD / 10u);
            hal_host_faults()->int1_cut = false;
            hal_host_drdy_handler();
            rig_run_ms(20);
            TEST_ASSERT_EQUAL_size_t(0, rig_lost(60));
        }
    }
}

/* The sensor has shown the sample whose first byte was cut (the model has not): it is gone from the FIFO. */
static void take_out_of_the_sensor(void)
{
    uint8_t count = hal_host_sensor()->fifo_count;
    adxl345_model_start(hal_host_sensor(), 0x53 << 1);
    adxl345_model_write(hal_host_sensor(), ADXL345_DATAX0);
    adxl345_model_start(hal_host_sensor(), (0x53 << 1) | 1);
    (void)adxl345_model_read(hal_host_sensor());
    adxl345_model_stop(hal_host_sensor());
    TEST_ASSERT_EQUAL_UINT8(count - 1, hal_host_sensor()->fifo_count);
}

/*
 * A burst is cut in its first data byte and the sample goes with it. Main is away until the next one has come: that has
 * an edge of its own, and the time of that.
 */
TEST(test_a_cut_in_the_first_data_byte_gives_no_stamp_away)
{
    stream_for_ms(300);
    size_t before = rig.taken_count;
    hal_host_faults()->status_skip = FIRST_DATA_EVENT;
    hal_host_faults()->next_status = HAL_I2C_BUS_ERROR;
    away_until_held(1);
    rig_away(BURST_US / 20u); /* the STOP is out */
    TEST_ASSERT_EQUAL(-1, hal_host_faults()->next_status);
    take_out_of_the_sensor();
    TEST_ASSERT_FALSE(hal_drdy_high());
    away_until_held(1);
    pass_until_taken(before + 1);
    TEST_ASSERT_TRUE(rig.off_us <= EXACT_US);
    rig_run_ms(50);
    TEST_ASSERT_EQUAL_size_t(1, rig_lost(60));
    TEST_ASSERT_TRUE(rig.off_us <= EXACT_US);
}

/*
 * INT1 goes high for nothing at any time between two samples, and stays so: the reading finds the sensor empty. Main
 * is away until the next sample is there, which has no edge: it came when it was due, not when the sensor was empty.
 */
TEST(test_a_sample_after_an_empty_reading_came_when_it_was_due)
{
    for (unsigned tenths = 1; tenths < 9; tenths++) {
        setUp();
        stream_for_ms(300);
        size_t before = rig.taken_count;
        pass_until_taken(before + 1);
        rig_away(tenths * PASSES_PER_PERIOD / 10u);
        hal_host_faults()->int1_high = true;
        hal_host_drdy_handler();
        rig_away(BURST_US / 20u);
        TEST_ASSERT_EQUAL(READING_EMPTY, adxl345_burst_judge());
        away_until_held(1);
        pass_until_taken(before + 2);
        TEST_ASSERT_TRUE(rig.off_us <= EXACT_US);
        hal_host_faults()->int1_high = false;
        TEST_ASSERT_EQUAL_size_t(0, rig_lost(60));
    }
}

/* INT1 is high without an edge when the first sample is there: the start left no time of an edge that it could get. */
TEST(test_a_first_sample_without_an_edge_has_the_time_at_which_it_was_found)
{
    hal_host_faults()->int1_cut = true;
    adxl345_start(&at_100_hz);
    rig_run_ms(5);
    away_until_held(1);
    hal_host_faults()->int1_cut = false;
    pass_until_taken(1);
    TEST_ASSERT_TRUE(rig.off_us <= EXACT_US);
}

/*
 * An edge waits for main to judge the burst before it when INT1 bounces: the second edge reads that sample. The next
 * one has no edge at all. It came one period later, not with the edge that waited.
 */
TEST(test_an_edge_that_waited_is_spent_by_the_edge_that_reads_its_sample)
{
    stream_for_ms(300);
    size_t before = rig.taken_count;
    away_until_held(1);
    rig_away(BURST_US / 20u);
    away_until_held(1);
    TEST_ASSERT_EQUAL(READING_GOOD, adxl345_burst_judge());
    TEST_ASSERT_FALSE(adxl345_burst_running());
    hal_host_drdy_handler();
    TEST_ASSERT_TRUE(adxl345_burst_running());
    rig_away(BURST_US / 20u);
    hal_host_faults()->int1_cut = true;
    TEST_ASSERT_EQUAL(READING_GOOD, adxl345_burst_judge());
    away_until_held(1);
    hal_host_faults()->int1_cut = false;
    pass_until_taken(before + 3);
    TEST_ASSERT_TRUE(rig.off_us <= EXACT_US);
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(60));
}

/*
 * Main looks for a sample that is overdue by half a period, and it comes while main claims the bus: the edge starts no
 * burst beside main's, and the sample has the time of that edge.
 */
TEST(test_an_edge_while_main_claims_the_bus_gives_the_time)
{
    stream_for_ms(300);
    adxl345_counters_t counters;
    hal_host_sensor()->reg[ADXL345_POWER_CTL] = 0;
    rig_away(3 * PASSES_PER_PERIOD / 2);
    hal_host_sensor()->reg[ADXL345_POWER_CTL] = ADXL345_POWER_MEASURE;
    sample_as_main_claims = true;
    uint32_t now_us = hal_time_us();
    adxl345_burst_read();
    TEST_ASSERT_FALSE(sample_as_main_claims);
    TEST_ASSERT_UINT32_WITHIN(EXACT_US, now_us, next_stamp_us());
    rig_take_all();
    adxl345_counters(&counters);
    TEST_ASSERT_EQUAL_UINT16(0, counters.samples_drained);
}
