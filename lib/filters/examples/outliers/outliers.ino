/*
 * A made-up signal, 4 LSB of noise, every seventh sample ruined: kf follows the ruin, sprf does not.
 * Open the serial plotter at 115200 baud. No sensor needed.
 */
#include <kf.h>
#include <noise.h>
#include <sprf.h>

static const uint16_t RATE_DHZ = 1000;  // 100 Hz

static kf_t plain;
static sprf_t robust;
static noise_t noise;

void setup()
{
    Serial.begin(115200);
    kf_config_t plain_config;
    kf_defaults(&plain_config, RATE_DHZ);
    kf_init(&plain, &plain_config);
    sprf_config_t robust_config;
    sprf_defaults(&robust_config, RATE_DHZ);
    sprf_init(&robust, &robust_config);
    noise_init(&noise, RATE_DHZ, false);
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
    if (noise_update(&noise, z)) {
        kf_set_noise(&plain, noise_r_lsb2_q8(&noise));
        sprf_set_noise(&robust, noise_r_lsb2_q8(&noise));
    }
    Serial.print("raw:");
    Serial.print(z);
    Serial.print(",kf:");
    Serial.print(kf_update(&plain, z) / 65536.0);
    Serial.print(",sprf:");
    Serial.println(sprf_update(&robust, z) / 65536.0);
    delay(10);
}
