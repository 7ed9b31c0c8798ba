/*
 * No transfer is broken. Flips, noise and doubled readings are applied to the bytes on their way to the master, after
 * the sensor, so that --served is still what the sensor latched. A frozen sensor latches the frozen readings, and
 * --served shows them. --altered lists what reached the master different from what was sent.
 */
#include "simrun_alter.h"

#include <string.h>

#include "adxl345_registers.h"
#include "simrun_mcu.h"
#include "simrun_output.h"
#include "simrun_sensor.h"
#include "simrun_transmitter.h"
#include "simrun_uart.h"

enum { AXES = 3, DATA_BYTES = 2 * AXES, PULSE_CYCLES = 64, NO_AXIS = AXES };
enum { BEYOND_RAIL = 8191, BEYOND_RAIL_NEGATIVE = -8192 }; /* of every range */

typedef struct {
    uint32_t sigma_lsb;
    bool doubled[AXES];
} change_t;

static uint8_t data_sent[DATA_BYTES];
static uint8_t data_arrived[DATA_BYTES];
static const char *file_path;
static FILE *altered_file;
static uint32_t altered_count;
static uint32_t flip_bits;
static change_t wanted;  /* for the next sample that is read */
static change_t present; /* for the sample in progress */
static size_t changed_axis = NO_AXIS;
static int16_t changed_lsb;
static bool frozen;
static bool has_kept;
static int16_t kept[AXES];
static uint64_t pulse_at = NEVER; /* the next pulse on INT1, or its end */
static uint64_t glitch_cycles = PULSE_CYCLES;
static uint64_t pulse_period; /* 0: one pulse */
static bool mixing;           /* the master reads data of the previous burst, until the end of this one */
static uint8_t data_before[DATA_BYTES];
static size_t clipped_axis = NO_AXIS;
static bool in_pulse;

static uint8_t random_mask(uint32_t bits)
{
    unsigned mask = 0;
    while (bits != 0) {
        unsigned bit = 1u << (mcu_random() % 8u);
        bits -= (mask & bit) == 0;
        mask |= bit;
    }
    return (uint8_t)mask;
}

/* Twelve uniform numbers less their mean: variance 1, magnitude at most 6. */
static double random_normal(void)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++) {
        sum += mcu_random() / 4294967296.0;
    }
    return sum;
}

static int16_t within_range(double lsb)
{
    uint8_t format = sensor.reg[ADXL345_DATA_FORMAT];
    bool full = (format & ADXL345_FORMAT_FULL_RES) != 0;
    double rail = 512u << (full ? format & ADXL345_FORMAT_RANGE_MASK : 0u);
    double whole = lsb < 0.0 ? -(double)(long)(0.5 - lsb) : (double)(long)(lsb + 0.5);
    whole = whole < -rail ? -rail : whole;
    return (int16_t)(whole > rail - 1.0 ? rail - 1.0 : whole);
}

static int16_t changed(size_t axis, int16_t lsb)
{
    double value = present.doubled[axis] ? 2.0 * lsb : lsb;
    if (present.sigma_lsb != 0) {
        value += present.sigma_lsb * random_normal();
    }
    return within_range(value);
}

/* The low byte comes first and decides; the high byte of the same reading follows it. */
static uint8_t data_byte(uint8_t offset, uint8_t byte)
{
    size_t axis = offset / 2u;
    if (offset == 0) {
        present = wanted;
        wanted = (change_t){ 0 };
    }
    if (offset % 2u != 0) {
        return axis == changed_axis ? (uint8_t)((uint16_t)changed_lsb >> 8) : byte;
    }
    changed_axis = NO_AXIS;
    if (present.doubled[axis] || present.sigma_lsb != 0) {
        changed_axis = axis;
        changed_lsb = changed(axis, (int16_t)(byte | sensor.reg[ADXL345_DATAX0 + offset + 1u] << 8));
        return (uint8_t)changed_lsb;
    }
    return byte;
}

static int reading(const uint8_t data[DATA_BYTES], size_t axis)
{
    return (int16_t)(data[2 * axis] | data[2 * axis + 1] << 8);
}

/* A data burst that was completed and differs from what the sensor sent. */
static void record_altered(void)
{
    if (memcmp(data_sent, data_arrived, DATA_BYTES) == 0) {
        return;
    }
    altered_count++;
    if (altered_file != NULL) {
        fprintf(altered_file, "%u,%llu", (unsigned)altered_count, (unsigned long long)(mcu->cycle / CYCLES_PER_US));
        for (size_t i = 0; i < 2 * (size_t)AXES; i++) {
            fprintf(altered_file, ",%d", reading(i < AXES ? data_arrived : data_sent, i % AXES));
        }
        fputc('\n', altered_file);
    }
}

static uint8_t on_sent(void *owner, uint8_t address, uint8_t byte)
{
    (void)owner;
    bool is_data = address >= ADXL345_DATAX0 && address < ADXL345_DATAX0 + DATA_BYTES;
    uint8_t offset = (uint8_t)(address - ADXL345_DATAX0);
    uint8_t arrived = is_data ? data_byte(offset, byte) : byte;
    if (is_data && mixing) {
        arrived = data_before[offset];
    }
    arrived ^= random_mask(flip_bits);
    flip_bits = 0;
    if (is_data) {
        data_sent[offset] = byte;
        data_arrived[offset] = arrived;
    }
    if (is_data && offset == DATA_BYTES - 1) {
        record_altered();
        memcpy(data_before, data_sent, sizeof data_before);
        mixing = false;
    }
    return arrived;
}

void alter_start(const char *path, twi_peripheral_t *twi)
{
    twi->sent = on_sent;
    if (path == NULL) {
        return;
    }
    file_path = path;
    altered_file = output_open(path);
    fputs("altered,t_us,x_lsb,y_lsb,z_lsb,x_sent_lsb,y_sent_lsb,z_sent_lsb\n", altered_file);
}

void alter_finish(void)
{
    output_close(altered_file, file_path);
}

uint32_t alter_count(void)
{
    return altered_count;
}

const int16_t *alter_sample(const int16_t lsb[3])
{
    if (!frozen || !has_kept) {
        memcpy(kept, lsb, sizeof kept);
        has_kept = true;
    }
    static int16_t measured[AXES];
    memcpy(measured, kept, sizeof measured);
    if (clipped_axis != NO_AXIS) {
        measured[clipped_axis] = kept[clipped_axis] < 0 ? BEYOND_RAIL_NEGATIVE : BEYOND_RAIL;
    }
    return measured;
}

uint64_t alter_next(void)
{
    return pulse_at;
}

/* Cycles; in a storm a pulse lasts at most half of its period. */
static uint64_t pulse_length(void)
{
    if (pulse_period == 0) {
        return glitch_cycles;
    }
    return pulse_period < 2 * PULSE_CYCLES ? pulse_period / 2 : PULSE_CYCLES;
}

/* A short pulse opposite to the level of INT1. */
void alter_step(void)
{
    if (pulse_at > mcu->cycle) {
        return;
    }
    in_pulse = !in_pulse;
    pulse_at += in_pulse ? pulse_length() : pulse_period - pulse_length(); /* from when it was due: keeps the rate */
    if (!in_pulse && pulse_period == 0) {
        pulse_at = NEVER;
    }
    sensor_disturb_int1(in_pulse);
}

void alter_begin(const fault_t *fault)
{
    uint32_t parameter = (uint32_t)fault->parameter;
    switch (fault->kind) {
    case KIND_FLIP:
        flip_bits = parameter;
        break;
    case KIND_NOISE:
        wanted.sigma_lsb = parameter;
        break;
    case KIND_DOUBLE:
        wanted.doubled[parameter] = true;
        break;
    case KIND_FROZEN:
        frozen = true;
        break;
    case KIND_STORM:
        pulse_period = (uint64_t)CYCLES_PER_MS * 1000u / parameter;
        pulse_at = in_pulse ? pulse_at : mcu->cycle;
        break;
    case KIND_GLITCH:
        glitch_cycles = parameter;
        pulse_at = pulse_at == NEVER ? mcu->cycle : pulse_at;
        break;
    case KIND_MIXED:
        mixing = true;
        break;
    case KIND_CLIP:
        clipped_axis = parameter;
        break;
    case KIND_ODR:
        sensor_set_clock_error(fault->parameter);
        break;
    case KIND_TXSTALL:
        transmitter_stall(fault->ends);
        break;
    case KIND_RXSPOIL:
        uart_spoil(fault->parameter == 1);
        break;
    default:
        uart_flood(true);
        break;
    }
}

bool alter_waits(kind_t kind)
{
    switch (kind) {
    case KIND_FLIP:
        return flip_bits != 0;
    case KIND_NOISE:
        return wanted.sigma_lsb != 0;
    case KIND_DOUBLE:
        return wanted.doubled[0] || wanted.doubled[1] || wanted.doubled[2];
    case KIND_MIXED:
        return mixing;
    default:
        return false;
    }
}

void alter_end(const fault_t *fault)
{
    switch (fault->kind) {
    case KIND_FROZEN:
        frozen = false;
        break;
    case KIND_STORM:
        pulse_at = NEVER;
        pulse_period = 0;
        in_pulse = false;
        sensor_disturb_int1(false);
        break;
    case KIND_ODR:
        sensor_restore_clock();
        break;
    case KIND_CLIP:
        clipped_axis = NO_AXIS;
        break;
    case KIND_RXSPOIL:
        break;
    case KIND_TXSTALL:
        transmitter_stall(0);
        break;
    default:
        uart_flood(false);
        break;
    }
}
