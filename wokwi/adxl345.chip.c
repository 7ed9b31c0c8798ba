/*
 * An ADXL345 for Wokwi: sim's sensor model behind Wokwi's chip API. The pins are the breakout's; roll, pitch, noise and
 * outliers are sliders. make wokwi packs it with the model into one file.
 */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

#include "adxl345_model.h"
#include "wokwi-api.h"

#define LSB_PER_G 256.0
#define LSB_MAX 4095.0
#define RADIANS_PER_DEGREE 0.017453292519943295
#define TURN_ON_NS 1100000.0 /* data sheet p. 5: 1.1 ms and a period after Measure was set */
#define OUTLIER_LSB 512.0

typedef struct {
    adxl345_model_t model;
    pin_t interrupt[3]; /* index 1, 2 */
    timer_t timer;
    double odr_hz; /* that the timer runs at; 0: stopped */
    uint32_t roll, pitch, noise, outliers;
    uint32_t random;
} chip_t;

static double random_unit(chip_t *chip)
{
    chip->random ^= chip->random << 13;
    chip->random ^= chip->random >> 17;
    chip->random ^= chip->random << 5;
    return chip->random / 4294967296.0;
}

/* Near enough to a normal distribution of mean 0 and deviation 1. */
static double random_normal(chip_t *chip)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++) {
        sum += random_unit(chip);
    }
    return sum;
}

static int16_t reading(chip_t *chip, double g)
{
    double lsb = g * LSB_PER_G + random_normal(chip) * (double)attr_read_float(chip->noise);
    if (random_unit(chip) * 100.0 < (double)attr_read_float(chip->outliers)) {
        lsb += (2.0 * random_unit(chip) - 1.0) * OUTLIER_LSB;
    }
    return (int16_t)lround(fmax(-LSB_MAX - 1.0, fmin(LSB_MAX, lsb)));
}

static void run_timer(chip_t *chip, double first_ns)
{
    chip->odr_hz = adxl345_model_odr_hz(&chip->model);
    if (chip->odr_hz > 0.0) {
        timer_start_ns(chip->timer, (uint64_t)(1e9 / chip->odr_hz + first_ns), false);
    } else {
        timer_stop(chip->timer);
    }
}

static void on_sample(void *user_data)
{
    chip_t *chip = user_data;
    const double roll = (double)attr_read_float(chip->roll) * RADIANS_PER_DEGREE;
    const double pitch = (double)attr_read_float(chip->pitch) * RADIANS_PER_DEGREE;
    const int16_t lsb[3] = { reading(chip, -sin(pitch)), reading(chip, cos(pitch) * sin(roll)),
                             reading(chip, cos(pitch) * cos(roll)) };
    adxl345_model_tick(&chip->model, lsb);
    run_timer(chip, 0.0);
}

static void on_pin(void *owner, unsigned pin, bool high)
{
    const chip_t *chip = owner;
    pin_write(chip->interrupt[pin], high ? HIGH : LOW);
}

static bool on_connect(void *user_data, uint32_t address, bool read)
{
    chip_t *chip = user_data;
    return adxl345_model_start(&chip->model, (uint8_t)(address << 1 | read));
}

static uint8_t on_read(void *user_data)
{
    chip_t *chip = user_data;
    return adxl345_model_read(&chip->model);
}

static bool on_write(void *user_data, uint8_t data)
{
    chip_t *chip = user_data;
    const bool taken = adxl345_model_write(&chip->model, data);
    if (adxl345_model_odr_hz(&chip->model) != chip->odr_hz) {
        run_timer(chip, chip->odr_hz > 0.0 ? 0.0 : TURN_ON_NS);
    }
    return taken;
}

static void on_disconnect(void *user_data)
{
    chip_t *chip = user_data;
    adxl345_model_stop(&chip->model);
}

void chip_init(void)
{
    chip_t *chip = calloc(1, sizeof *chip);
    adxl345_model_init(&chip->model);
    chip->model.owner = chip;
    chip->model.pin_changed = on_pin;
    chip->model.address = attr_read(attr_init("altAddress", 0)) != 0 ? 0x1D : 0x53;
    chip->random = 1;
    chip->roll = attr_init_float("roll", 0.0F);
    chip->pitch = attr_init_float("pitch", 0.0F);
    chip->noise = attr_init_float("noise", 1.0F);
    chip->outliers = attr_init_float("outliers", 0.0F);
    chip->interrupt[1] = pin_init("INT1", OUTPUT_LOW);
    chip->interrupt[2] = pin_init("INT2", OUTPUT_LOW);
    const timer_config_t timer = { .user_data = chip, .callback = on_sample };
    chip->timer = timer_init(&timer);
    const i2c_config_t i2c = {
        .user_data = chip,
        .address = chip->model.address,
        .scl = pin_init("SCL", INPUT_PULLUP),
        .sda = pin_init("SDA", INPUT_PULLUP),
        .connect = on_connect,
        .read = on_read,
        .write = on_write,
        .disconnect = on_disconnect,
    };
    i2c_init(&i2c);
}
