/*
 * Roll and pitch from an ADXL345 at 100 Hz, in degrees, for the serial plotter at 115200 baud. Outliers are rejected, a
 * failed reading is repeated, and the sketch recovers from a hung bus and from a sensor that lost its supply. SDA to
 * A4, SCL to A5 (through a level shifter: the sensor is a 3.3 V part), CS to 3.3 V, SDO to GND.
 */
#include <Wire.h>
#include <tilt_filter.h>

static const uint8_t ADXL345 = 0x53;
static const uint8_t DEVID = 0x00, BW_RATE = 0x2C, POWER_CTL = 0x2D;
static const uint8_t INT_SOURCE = 0x30, DATA_FORMAT = 0x31, DATA = 0x32;
static const uint8_t DATA_READY = 0x80;
static const uint8_t RATE_HZ = 100, PERIOD_MS = 1000 / RATE_HZ;

static tilt_filter_t tilt;
static bool configured = false;
static uint8_t missing = 0;
static uint32_t due_ms;  // when the next sample counts as missing

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
    pinMode(SCL, OUTPUT);  // low; the lines are never driven high
    delayMicroseconds(5);
    pinMode(SCL, INPUT);
    delayMicroseconds(5);
}

// Nine clocks and a STOP free a sensor that was interrupted in the middle of a byte. Wire does not do this.
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
    digitalWrite(SDA, LOW);  // disable the pull-ups to 5 V: the sensor's go to 3.3 V
    digitalWrite(SCL, LOW);
    Wire.setClock(400000);
    Wire.setWireTimeout(3000, true);  // off by default: a hung bus would stop the sketch for ever
}

// In standby, Measure bit last (data sheet, p. 13): 100 Hz, 16 g, full resolution.
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

// In full resolution the upper bits repeat the sign: a reading of more than 13 bits was corrupted by a bus fault.
static bool read_sample(int16_t lsb[3])
{
    uint8_t bytes[6];
    bool whole = read_registers(DATA, bytes, sizeof bytes);
    for (uint8_t axis = 0; whole && axis < 3; axis++) {
        lsb[axis] = (int16_t)(bytes[2 * axis] | (uint16_t)bytes[2 * axis + 1] << 8);
        whole = lsb[axis] >= -4096 && lsb[axis] <= 4095;
    }
    return whole;
}

static void print_number(const char *name, int16_t value)
{
    Serial.print(name);
    Serial.print(value);
}

static void print_degrees(const char *name, int16_t cdeg)
{
    Serial.print(name);
    Serial.print(cdeg / 100.0);
}

static void take_sample(const int16_t lsb[3])
{
    tilt_filter_update(&tilt, lsb[0], lsb[1], lsb[2]);
    print_number("x:", lsb[0]);
    print_number(",y:", lsb[1]);
    print_number(",z:", lsb[2]);
    print_degrees(",roll:", tilt.angles.roll_cdeg);
    print_degrees(",pitch:", tilt.angles.pitch_cdeg);
    print_number(",flags:", tilt.flags);
    Serial.println();
}

// The filter predicts for 100 ms, then holds. After five missing samples the sensor may have lost its supply.
static void miss_sample()
{
    tilt_filter_missing(&tilt);
    if (++missing == 5) {
        missing = 0;
        configured = false;
    }
}

void setup()
{
    Serial.begin(115200);
    tilt_filter_begin(&tilt, RATE_HZ);
    due_ms = millis();
}

void loop()
{
    if (!configured) {
        start_bus();
        configured = configure();
    }
    int16_t lsb[3];
    if (configured && sample_waits() && read_sample(lsb)) {
        due_ms = millis() + PERIOD_MS + PERIOD_MS / 2;
        missing = 0;
        take_sample(lsb);
    } else if ((int32_t)(millis() - due_ms) >= 0) {
        due_ms += PERIOD_MS;
        miss_sample();
    }
}
