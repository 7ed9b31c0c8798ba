/*
 * Filters a single number, without the tilt part. The signal is synthetic: 4 LSB of noise, every seventh sample an
 * outlier. kf follows the outliers, sprf does not. Open the serial plotter at 115200 baud. No sensor needed.
 */
#include <filter.h>
#include <noise.h>

static const uint16_t RATE_HZ = 100;
static const uint16_t RATE_DHZ = RATE_HZ * 10;  // the filters count in units of 0.1 Hz

static filter_t plain;
static filter_t robust;
static noise_t noise;

void setup()
{
    Serial.begin(115200);
    filter_config_t config = filter_defaults(&filter_law_kf, RATE_DHZ);
    filter_init(&plain, &filter_law_kf, &config);
    config = filter_defaults(&filter_law_sprf, RATE_DHZ);
    filter_init(&robust, &filter_law_sprf, &config);
    filter_noise_init(&noise, RATE_DHZ, false);
}

void loop()
{
    static uint16_t k = 0;
    k++;
    int16_t level = (k / 300) % 2 ? 100 : -100;
    int16_t z = level + random(-6, 7);
    if (random(7) == 0) {
        z += random(-300, 301);
    }
    if (filter_noise_update(&noise, z)) {
        filter_set_noise(&plain, filter_noise_r_lsb2_q8(&noise));
        filter_set_noise(&robust, filter_noise_r_lsb2_q8(&noise));
    }
    Serial.print("raw:");
    Serial.print(z);
    Serial.print(",kf:");
    Serial.print(filter_update(&plain, z) / 65536.0);
    Serial.print(",sprf:");
    Serial.println(filter_update(&robust, z) / 65536.0);
    delay(10);
}
