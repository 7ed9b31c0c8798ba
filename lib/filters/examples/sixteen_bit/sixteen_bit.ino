/*
 * Roll from a 16-bit sensor, an MPU-6050 in its 2 g range: 16384 LSB per g. The facade shifts its readings into the
 * range that the filters take. The readings here are synthetic (a slow roll of +-30 degrees with noise, one in twenty
 * an outlier), so that the sketch needs no sensor. With a sensor, take_sample passes on what its driver reads. Open the
 * serial plotter at 115200 baud.
 */
#include <tilt_filter.h>

static const uint16_t LSB_PER_G = 16384;
static const uint8_t RATE_HZ = 100;

static tilt_filter_t tilt;

static void take_sample(int16_t ax, int16_t ay, int16_t az)
{
    tilt_filter_update(&tilt, ax, ay, az);
    Serial.print("x:");
    Serial.print(ax);
    Serial.print(",y:");
    Serial.print(ay);
    Serial.print(",z:");
    Serial.print(az);
    Serial.print(",roll:");
    Serial.print(tilt.angles.roll_cdeg / 100.0);
    Serial.print(",flags:");
    Serial.println(tilt.flags);
}

static int16_t with_noise(float g)
{
    return (int16_t)(LSB_PER_G * g) + (int16_t)random(-200, 201);
}

void setup()
{
    Serial.begin(115200);
    tilt_filter_begin(&tilt, RATE_HZ);
    if (!tilt_filter_sensor(&tilt, 16, LSB_PER_G, LSB_PER_G)) {
        Serial.println("# this scale is not legal");
    }
}

void loop()
{
    static uint16_t k = 0;
    float roll = 0.52 * sin(k++ * 0.01);
    bool ruined = random(20) == 0;
    take_sample(with_noise(0), ruined ? random(-32768, 32767) : with_noise(sin(roll)), with_noise(cos(roll)));
    delay(1000 / RATE_HZ);
}
