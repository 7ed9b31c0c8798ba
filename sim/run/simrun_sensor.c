/* Each output-data-rate period takes a row of the stream. */
#include "simrun_sensor.h"

#include <string.h>

#include "adxl345_registers.h"
#include "avr_ioport.h"
#include "feed.h"
#include "sim_io.h"
#include "simrun_events.h"
#include "simrun_mcu.h"
#include "simrun_output.h"
#include "simrun_times.h"
#include "simrun_vcd.h"

#define TURN_ON_US 1100.0 /* first data one period and 1.1 ms after Measure (data sheet p. 5) */

enum { REG_PIND = 0x29, PIN_D2 = 2 };

adxl345_model_t sensor;

static const int16_t *(*measure)(const int16_t lsb[3]);
static void (*on_sample)(void);
static stream_t stream;
static feed_t feed;
static double odr_hz;
static double last_odr_hz;
static double next_tick; /* cycles */
static uint64_t last_tick;
static size_t row_now;
static uint64_t over_at = NEVER;
static bool int1_cut, int1_held_high, int1_disturbed;
static double own_error_ppm, clock_error_ppm;
static avr_irq_t *pin_d2;
static FILE *served_file;
static const char *served_path;
static served_t served[2 * SERVED_KEPT]; /* the newest; when it is full the older half is dropped */
static size_t kept_count, served_count;
static bool mode_used[2];

static void on_pin(void *owner, unsigned pin, bool high)
{
    (void)owner;
    (void)high;
    if (pin == 1) {
        sensor_show_pin();
    }
}

void sensor_show_pin(void)
{
    bool high = (int1_held_high || (sensor.pin_high[1] && !int1_cut)) != int1_disturbed;
    avr_raise_irq(pin_d2, high);
    /* after a reset PIND is 0 and simavr's IRQ is silent, because the level has not changed for it */
    uint8_t mask = 1u << PIN_D2;
    mcu->data[REG_PIND] = (uint8_t)(high ? mcu->data[REG_PIND] | mask : mcu->data[REG_PIND] & (uint8_t)~mask);
    vcd_change(VCD_INT1, high);
}

void sensor_hold_int1(bool cut, bool high)
{
    int1_cut = cut;
    int1_held_high = high;
    sensor_show_pin();
}

void sensor_disturb_int1(bool disturbed)
{
    int1_disturbed = disturbed;
    sensor_show_pin();
}

static void write_served(const int16_t lsb[3])
{
    const stream_row_t *row = &stream.rows[row_now];
    fprintf(served_file, "%zu,%llu,%zu,%u,%d,%d,%d", served_count, (unsigned long long)(mcu->cycle / CYCLES_PER_US),
            row_now, (unsigned)row->line, lsb[0], lsb[1], lsb[2]);
    if (stream.has_truth) {
        fprintf(served_file, ",%d,%d", row->truth_cdeg[0], row->truth_cdeg[1]);
    }
    fputc('\n', served_file);
}

static void on_latched(void *owner, const int16_t lsb[3])
{
    (void)owner;
    if (served_file != NULL) {
        write_served(lsb);
    }
    if (kept_count == 2 * (size_t)SERVED_KEPT) {
        memcpy(served, served + SERVED_KEPT, SERVED_KEPT * sizeof *served);
        kept_count = SERVED_KEPT;
    }
    served[kept_count] = (served_t){ .cycle = mcu->cycle, .lsb = { lsb[0], lsb[1], lsb[2] } };
    kept_count++;
    served_count++;
}

void sensor_set_clock_error(double ppm)
{
    clock_error_ppm = ppm;
}

void sensor_restore_clock(void)
{
    clock_error_ppm = own_error_ppm;
}

void sensor_start(const sensor_options_t *wanted)
{
    if (wanted->in != NULL && !stream_load(&stream, wanted->in)) {
        output_refuse("%s", stream.error);
    }
    if (wanted->served != NULL) {
        served_path = wanted->served;
        served_file = output_open(served_path);
        fprintf(served_file, "served,t_us,row,line,x_lsb,y_lsb,z_lsb%s\n",
                stream.has_truth ? ",roll_true_cdeg,pitch_true_cdeg" : "");
    }
    pin_d2 = avr_io_getirq(mcu, AVR_IOCTL_IOPORT_GETIRQ('D'), PIN_D2);
    adxl345_model_init(&sensor);
    adxl345_model_become(&sensor, wanted->variant);
    sensor.part = wanted->part;
    if (wanted->alt_address) {
        sensor.address = ADXL345_ADDRESS_HIGH;
    }
    own_error_ppm = wanted->ppm;
    sensor_restore_clock();
    sensor.pin_changed = on_pin;
    sensor.latched = on_latched;
    feed = (feed_t){ .stream = &stream, .loop = wanted->loop };
    sensor_show_pin();
}

void sensor_hook(const int16_t *(*measured)(const int16_t lsb[3]), void (*sampled)(void))
{
    measure = measured;
    on_sample = sampled;
}

void sensor_finish(void)
{
    output_close(served_file, served_path);
    stream_free(&stream);
}

static double period_cycles(void)
{
    return (double)CYCLES_PER_MS * 1000.0 / (odr_hz * (1.0 + clock_error_ppm * 1e-6));
}

uint64_t sensor_next(void)
{
    return odr_hz > 0.0 ? (uint64_t)next_tick : NEVER;
}

void sensor_check_rate(void)
{
    double now_hz = adxl345_model_odr_hz(&sensor);
    bool unchanged = now_hz >= odr_hz && now_hz <= odr_hz;
    if (unchanged) {
        return;
    }
    odr_hz = now_hz;
    if (odr_hz > 0.0) {
        last_odr_hz = odr_hz;
        next_tick = (double)mcu->cycle + period_cycles() + TURN_ON_US * CYCLES_PER_US;
        feed_set_rate(&feed, &stream, odr_hz, mcu->cycle / CYCLES_PER_US);
        mode_used[feed.mode] = true;
    }
    events_reschedule();
}

void sensor_step(void)
{
    next_tick += period_cycles();
    last_tick = mcu->cycle;
    if (over_at != NEVER) {
        return;
    }
    size_t row = 0;
    int16_t lsb[3];
    switch (feed_tick(&feed, mcu->cycle / CYCLES_PER_US, &row)) {
    case FEED_SAMPLE:
        row_now = row;
        memcpy(lsb, stream.rows[row].lsb, sizeof lsb);
        feed_vary(&feed, lsb);
        (void)adxl345_model_tick(&sensor, measure(lsb));
        on_sample();
        break;
    case FEED_NOTHING:
        break;
    default:
        over_at = mcu->cycle;
        times_streaming_ends();
        break;
    }
}

uint64_t sensor_last_tick(void)
{
    return last_tick;
}

uint64_t sensor_over_at(void)
{
    return over_at;
}

double sensor_period_us(void)
{
    return last_odr_hz > 0.0 ? 1e6 / last_odr_hz : 0.0;
}

double sensor_true_period_us(void)
{
    return sensor_period_us() / (1.0 + clock_error_ppm * 1e-6);
}

size_t sensor_served_count(void)
{
    return served_count;
}

served_t *sensor_served_lately(size_t *count)
{
    *count = kept_count;
    return served;
}

/* A tick is a measurement: there is none in standby or without power. */
void sensor_print(FILE *json)
{
    fprintf(json, "  \"samples_served\": %zu,\n  \"sensor_overruns\": %u,\n", served_count, (unsigned)sensor.overruns);
    fprintf(json, "  \"sensor\": \"%s\",\n  \"sensor_hz\": %.4g,\n  \"sensor_range_g\": %.4g,\n", sensor.variant->name,
            adxl345_model_odr_hz(&sensor), adxl345_model_range_g(&sensor));
    fprintf(json, "  \"sensor_last_tick_ms\": %.3f,\n", (double)last_tick / CYCLES_PER_MS);
}

void sensor_print_mode(FILE *to)
{
    if (mode_used[FEED_ROW_PER_TICK]) {
        fprintf(to, "simrun: feed: one row per sample (stream %.4g Hz)\n", stream.rate_hz);
    }
    if (mode_used[FEED_IN_FORCE]) {
        fprintf(to, "simrun: feed: the row in force at each sample's time (stream %.4g Hz, sensor %.4g Hz)\n",
                stream.rate_hz, last_odr_hz);
    }
}
