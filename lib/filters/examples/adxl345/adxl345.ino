/*
 * An ADXL345 at 100 Hz, raw and filtered, in LSB (256 per g), for the serial plotter at 115200 baud. Outliers are
 * refused, a reading that fails is made again, and behind a bus that hung or a sensor that lost its supply the sketch
 * goes on.
 * SDA to A4, SCL to A5 (through a level shifter: the sensor is a 3.3 V part), CS to 3.3 V, SDO to GND.
 */
#include <Wire.h>
#include <filter.h>
#include <noise.h>

static const uint8_t ADXL345 = 0x53;
static const uint8_t DEVID = 0x00, BW_RATE = 0x2C, POWER_CTL = 0x2D;
static const uint8_t INT_SOURCE = 0x30, DATA_FORMAT = 0x31, DATA = 0x32;
static const uint8_t DATA_READY = 0x80;
static const uint16_t RATE_DHZ = 1000;  // 100 Hz
static const char NAMES[] = "xyz";

static filter_t filters[3];
static noise_t noises[3];
static bool configured = false;
static uint32_t heard_ms;

static bool write_register(uint8_t reg, uint8_t value)
{
    Wire.beginTransmission(ADXL345);
    Wire.write(reg);
    Wire.write(value);
    return Wire.endTransmission() == 0;
}

static bool read_registers(uint8_t reg, uint8_t *bytes, uint8_t count)
{
    Wire.beginTransmission(ADXL345);
    Wire.write(reg);
    if (Wire.endTransmission(false) != 0 || Wire.requestFrom(ADXL345, count) != count) {
        return false;
    }
    for (uint8_t i = 0; i < count; i++) {
        bytes[i] = Wire.read();
    }
    return true;
}

static void clock_pulse()
{
    pinMode(SCL, OUTPUT);  // low; nobody drives the lines high
    delayMicroseconds(5);
    pinMode(SCL, INPUT);
    delayMicroseconds(5);
}

// Nine clocks and a STOP free a sensor that was left in the middle of a byte, which Wire does not.
static void start_bus()
{
    Wire.end();
    digitalWrite(SDA, LOW);
    digitalWrite(SCL, LOW);
    for (uint8_t i = 0; i < 9; i++) {
        clock_pulse();
    }
    pinMode(SDA, OUTPUT);
    clock_pulse();
    pinMode(SDA, INPUT);
    Wire.begin();
    digitalWrite(SDA, LOW);  // the pull-ups to 5 V off: the sensor's are to 3.3 V
    digitalWrite(SCL, LOW);
    Wire.setClock(400000);
    Wire.setWireTimeout(3000, true);  // off by default: a bus that hangs would stop the sketch for ever
}

// In standby, Measure last (data sheet, p. 13): 100 Hz, 16 g, full resolution.
static bool configure()
{
    uint8_t id;
    return read_registers(DEVID, &id, 1) && id == 0xE5 && write_register(POWER_CTL, 0x00) &&
           write_register(BW_RATE, 0x0A) && write_register(DATA_FORMAT, 0x0B) && write_register(POWER_CTL, 0x08);
}

static bool sample_waits()
{
    uint8_t source;
    return read_registers(INT_SOURCE, &source, 1) && (source & DATA_READY) != 0;
}

static int32_t filtered(uint8_t axis, int16_t lsb)
{
    if (noise_update(&noises[axis], lsb)) {
        filter_set_noise(&filters[axis], noise_r_lsb2_q8(&noises[axis]));
    }
    return filter_update(&filters[axis], lsb);
}

static void print_sample(const uint8_t bytes[6])
{
    for (uint8_t axis = 0; axis < 3; axis++) {
        int16_t lsb = (int16_t)(bytes[2 * axis] | (uint16_t)bytes[2 * axis + 1] << 8);
        Serial.print(axis == 0 ? "" : ",");
        Serial.print(NAMES[axis]);
        Serial.print("_raw:");
        Serial.print(lsb);
        Serial.print(',');
        Serial.print(NAMES[axis]);
        Serial.print(':');
        Serial.print(filtered(axis, lsb) / 65536.0);
    }
    Serial.println();
}

void setup()
{
    Serial.begin(115200);
    filter_config_t config = filter_defaults(&filter_law_sprf, RATE_DHZ);
    for (uint8_t axis = 0; axis < 3; axis++) {
        filter_init(&filters[axis], &filter_law_sprf, &config);
        noise_init(&noises[axis], RATE_DHZ, axis == 2);
    }
}

void loop()
{
    if (!configured) {
        start_bus();
        configured = configure();
        heard_ms = millis();
        return;
    }
    uint8_t bytes[6];
    if (sample_waits() && read_registers(DATA, bytes, sizeof bytes)) {
        heard_ms = millis();
        print_sample(bytes);
    } else if (millis() - heard_ms >= 50) {  // five samples are missing: the sensor may have lost its supply
        for (uint8_t axis = 0; axis < 3; axis++) {
            filter_restart(&filters[axis]);
            noise_gap(&noises[axis]);
        }
        configured = false;
    }
}
