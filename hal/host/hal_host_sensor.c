/* The virtual sensor: its clock, which takes one row of the stream per output data period, and its INT1 line. */
#include <string.h>

#include "hal_drdy.h"
#include "hal_host_private.h"

#define TURN_ON_US 1100.0 /* data sheet p. 5: first data one period and 1.1 ms after Measure */

static adxl345_model_t sensor;
static const stream_t *source;
static feed_t feed;
static double odr_hz;
static double next_tick; /* cycles */
static bool over;
static size_t row_latched;
static bool drdy_enabled;
static bool drdy_edge;
static bool drdy_blocked;  /* main is in a critical section */
static uint8_t edges_left; /* in this tick; 0 after a reset acts as 256 */
static uint8_t deaf_ticks;

void hal_host_drdy_handler(void);

/* Not while D2 is muted: its interrupt flag is cleared at the end of that time. */
static bool heard(void)
{
    return drdy_enabled && deaf_ticks <= 1;
}

void hal_host_drdy_edge(void)
{
    if (heard()) {
        hal_host_drdy_handler();
    }
}

static void pin_changed(void *owner, unsigned pin, bool high)
{
    (void)owner;
    if (pin == 1 && high && heard() && !hal_host_faults()->int1_cut && !hal_host_faults()->int1_high) {
        drdy_edge = true;
    }
}

void host_drdy_reset(void)
{
    drdy_enabled = false;
    drdy_edge = false;
    drdy_blocked = false;
    edges_left = 0;
    deaf_ticks = 0;
}

void host_drdy_serve(void)
{
    while (drdy_edge && !drdy_blocked) {
        drdy_edge = false;
        hal_host_drdy_handler();
    }
}

bool host_drdy_block(bool blocked)
{
    bool before = drdy_blocked;
    drdy_blocked = blocked;
    host_drdy_serve();
    return before;
}

void hal_drdy_enable(void)
{
    drdy_enabled = true;
}

void host_drdy_tick(void)
{
    edges_left = HAL_DRDY_EDGES;
    if (deaf_ticks != 0) {
        edges_left = HAL_DRDY_EDGES_AGAIN;
        deaf_ticks--;
    }
}

bool hal_drdy_flickers(void)
{
    return deaf_ticks != 0;
}

bool host_drdy_counts(void)
{
    edges_left--;
    if (edges_left == 0) {
        deaf_ticks = HAL_DRDY_DEAF_TICKS;
    }
    return hal_drdy_high();
}

bool hal_drdy_high(void)
{
    if (hal_drdy_flickers()) {
        return false;
    }
    return hal_host_faults()->int1_high || (sensor.pin_high[1] && !hal_host_faults()->int1_cut);
}

static void latched(void *owner, const int16_t lsb[3])
{
    (void)owner;
    if (host_config()->on_latched != NULL) {
        host_config()->on_latched(hal_host_now() / HOST_CYCLES_PER_US, row_latched, lsb);
    }
}

adxl345_model_t *hal_host_sensor(void)
{
    return &sensor;
}

void host_sensor_begin(const stream_t *stream, bool loop)
{
    adxl345_model_init(&sensor);
    sensor.pin_changed = pin_changed;
    sensor.latched = latched;
    source = stream;
    feed = (feed_t){ .stream = stream, .loop = loop };
    odr_hz = 0.0;
    over = false;
}

static double period_cycles(void)
{
    return (double)HAL_HOST_HZ / (odr_hz * (1.0 + host_config()->ppm * 1e-6));
}

uint64_t host_sensor_next(void)
{
    return odr_hz > 0.0 ? (uint64_t)next_tick : HOST_NEVER;
}

void host_sensor_check_rate(void)
{
    double now_hz = adxl345_model_odr_hz(&sensor);
    bool unchanged = now_hz >= odr_hz && now_hz <= odr_hz;
    if (unchanged) {
        return;
    }
    odr_hz = now_hz;
    if (odr_hz > 0.0) {
        next_tick = (double)hal_host_now() + period_cycles() + TURN_ON_US * HOST_CYCLES_PER_US;
        if (source != NULL) {
            feed_set_rate(&feed, source, odr_hz, hal_host_now() / HOST_CYCLES_PER_US);
        }
    }
}

void host_sensor_step(void)
{
    next_tick += period_cycles();
    host_sensor_check_rate();
    if (source == NULL || over) {
        return;
    }
    size_t row = 0;
    int16_t lsb[3];
    switch (feed_tick(&feed, hal_host_now() / HOST_CYCLES_PER_US, &row)) {
    case FEED_SAMPLE:
        row_latched = row;
        memcpy(lsb, source->rows[row].lsb, sizeof lsb);
        feed_vary(&feed, lsb);
        (void)adxl345_model_tick(&sensor, lsb);
        break;
    case FEED_NOTHING:
        break;
    default:
        over = true;
        break;
    }
}

bool hal_host_stream_over(void)
{
    return over;
}
