#include "support/sensor_bus.h"

#include <string.h>

adxl345_model_t sensor_model;
sensor_seen_t sensor_seen;

static void expect(bool good)
{
    sensor_seen.wrong += !good;
}

static void pin_changed(void *owner, unsigned pin, bool high)
{
    expect(owner == &sensor_model);
    if (high) {
        sensor_seen.rises[pin]++;
    } else {
        sensor_seen.falls[pin]++;
    }
}

static void latched(void *owner, const int16_t lsb[3])
{
    expect(owner == &sensor_model);
    sensor_seen.latched++;
    memcpy(sensor_seen.last, lsb, sizeof sensor_seen.last);
}

void sensor_bus_begin(void)
{
    adxl345_model_init(&sensor_model);
    sensor_model.owner = &sensor_model;
    sensor_model.pin_changed = pin_changed;
    sensor_model.latched = latched;
    memset(&sensor_seen, 0, sizeof sensor_seen);
}

void sensor_write(uint8_t address, uint8_t value)
{
    expect(adxl345_model_start(&sensor_model, ADDRESS_WRITE));
    expect(adxl345_model_write(&sensor_model, address));
    expect(adxl345_model_write(&sensor_model, value));
    adxl345_model_stop(&sensor_model);
}

void sensor_begin_read(uint8_t address)
{
    expect(adxl345_model_start(&sensor_model, ADDRESS_WRITE));
    expect(adxl345_model_write(&sensor_model, address));
    expect(adxl345_model_start(&sensor_model, ADDRESS_READ));
}

uint8_t sensor_read(uint8_t address)
{
    sensor_begin_read(address);
    uint8_t value = adxl345_model_read(&sensor_model);
    adxl345_model_stop(&sensor_model);
    return value;
}

int16_t sensor_read_word(void)
{
    unsigned low = adxl345_model_read(&sensor_model);
    return (int16_t)(uint16_t)(low | (unsigned)adxl345_model_read(&sensor_model) << 8);
}

int16_t sensor_read_x(void)
{
    sensor_begin_read(DATAX0);
    int16_t x = sensor_read_word();
    (void)sensor_read_word();
    (void)sensor_read_word();
    adxl345_model_stop(&sensor_model);
    return x;
}

bool sensor_tick(int x, int y, int z)
{
    int16_t full[3] = { (int16_t)x, (int16_t)y, (int16_t)z };
    return adxl345_model_tick(&sensor_model, full);
}

void sensor_measure(uint8_t format, uint8_t fifo_ctl)
{
    sensor_write(DATA_FORMAT, format);
    sensor_write(FIFO_CTL, fifo_ctl);
    sensor_write(INT_ENABLE, DATA_READY);
    sensor_write(POWER_CTL, MEASURE);
}
