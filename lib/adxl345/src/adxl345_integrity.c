#include "adxl345_integrity.h"

#include "adxl345_counters.h"
#include "adxl345_registers.h"
#include "adxl345_table.h"
#include "hal_drdy.h"
#include "machine.h"

/*
 * Length at which a run counts. Values above it: in bad_run, the sensor's registers are those after power-on; in
 * empty_run, good readings that must leave INT1 low before it is trusted again.
 */
enum { RUN_LIMIT = 3, RUN_RESET, RUN_EMPTY = RUN_LIMIT + 31 };

static struct integrity {
    uint8_t equal_run; /* good readings equal to the previous one */
    bool has_last;
    uint8_t range_g;
    uint8_t format; /* content of DATA_FORMAT */
    uint8_t bad_run;
    uint8_t empty_run;
} integrity;

/* With the address in a register, an access takes half the code. */
static inline struct integrity *here(void)
{
    struct integrity *i = &integrity;
    MACHINE_POINTER(i);
    return i;
}

void adxl345_integrity_forget(void)
{
    integrity.equal_run = 0;
    integrity.empty_run = 0;
}

void adxl345_integrity_start(const adxl345_config_t *config)
{
    struct integrity *i = here();
    i->range_g = config->range_g;
    i->format = adxl345_table_format(config);
    i->has_last = false;
    i->bad_run = 0;
    if (i->equal_run != ADXL345_STUCK_REPEATS) {
        i->equal_run = 0;
    }
}

/*
 * Converts the data to lsb. Plausible: the bits above the range match the sign on every axis (the high byte is -range_g
 * to range_g - 1), and not all bits are ones (a bus that nobody drives).
 */
static inline bool plausible(const uint8_t *raw, int16_t lsb[3])
{
    uint8_t range_g = integrity.range_g;
    uint8_t above = 0;
    uint8_t ones = UINT8_MAX;
    for (uint8_t axis = 3; axis != 0; axis--) {
        uint8_t low = *raw++;
        uint8_t high = *raw++;
        ones &= (uint8_t)(low & high);
        *lsb++ = (int16_t)(uint16_t)(low | (uint16_t)((uint16_t)high << 8));
        above |= (uint8_t)(high + range_g);
    }
    if (ones == UINT8_MAX) {
        above = UINT8_MAX;
    }
    return above < (uint8_t)(2u * range_g);
}

static bool same(const int16_t *a, const int16_t *b)
{
    uint8_t axis = 3;
    while (axis != 0 && *a++ == *b++) {
        axis--;
    }
    return axis == 0;
}

static void lengthen(uint8_t *run)
{
    if (*run < RUN_LIMIT) {
        (*run)++;
    }
}

void adxl345_integrity_int1_lied(void)
{
    struct integrity *i = here();
    lengthen(&i->empty_run);
    if (i->empty_run == RUN_LIMIT) {
        i->empty_run = RUN_EMPTY;
    }
    adxl345_counters_add(COUNTER_EMPTY);
}

static reading_t discard(reading_t why)
{
    struct integrity *i = here();
    adxl345_counters_mark(ADXL345_MARK_INTEGRITY);
    lengthen(&i->bad_run);
    if (why == READING_RESET) {
        i->bad_run = RUN_RESET;
    }
    adxl345_counters_add(COUNTER_FAILED);
    return why;
}

static void accept(uint8_t source, bool repeated)
{
    struct integrity *i = here();
    if (!repeated) {
        if (i->has_last) {
            i->equal_run = 0;
        }
    } else if (i->equal_run != ADXL345_STUCK_REPEATS) {
        i->equal_run++;
    }
    i->has_last = true;
    i->bad_run = 0;
    if (!hal_drdy_high()) {
        i->empty_run = i->empty_run > RUN_LIMIT && !hal_drdy_flickers() ? (uint8_t)(i->empty_run - 1u) : 0;
    }
    if (source & ADXL345_INT_OVERRUN) {
        adxl345_counters_add(COUNTER_OVERRUNS);
    }
}

/*
 * A reading that ended with its second byte because there was no sample. After power-on DATA_FORMAT is 0 and INT_SOURCE
 * has the watermark bit (p. 26), so bits zeroed by a low SDA do not pass for a lost configuration.
 */
static reading_t judge_empty(const uint8_t reading[READING_BYTES])
{
    uint8_t format = reading[READING_FORMAT];
    uint8_t source = reading[READING_SOURCE];
    if (format == 0 && (source & ADXL345_INT_WATERMARK)) {
        return discard(READING_RESET);
    }
    return format == integrity.format ? READING_EMPTY : discard(READING_BAD);
}

/* FIFO_STATUS: bit 7 is the trigger's, which is unused, and bit 6 is always 0 (p. 28). */
MACHINE_APART reading_t adxl345_integrity_judge(const uint8_t reading[READING_BYTES], int16_t lsb[3],
                                                const int16_t last_lsb[3])
{
    uint8_t source = reading[READING_SOURCE];
    if (!(source & ADXL345_INT_DATA_READY)) {
        return judge_empty(reading);
    }
    if (reading[READING_FIFO_CTL] != TABLE_FIFO_CTL || reading[READING_FORMAT] != integrity.format ||
        reading[READING_FIFO_STATUS] > ADXL345_DEPTH || !plausible(&reading[READING_DATA], lsb)) {
        return discard(READING_BAD);
    }
    accept(source, integrity.has_last && same(lsb, last_lsb));
    return READING_GOOD;
}

adxl345_fault_t adxl345_integrity_fault(void)
{
    if (integrity.bad_run < RUN_LIMIT) {
        return ADXL345_FAULT_NONE;
    }
    return integrity.bad_run == RUN_RESET ? ADXL345_FAULT_NO_DATA : ADXL345_FAULT_TORN;
}

bool adxl345_integrity_int1_stuck(void)
{
    return integrity.empty_run >= RUN_LIMIT;
}

bool adxl345_integrity_stuck(void)
{
    return integrity.equal_run == ADXL345_STUCK_REPEATS;
}
