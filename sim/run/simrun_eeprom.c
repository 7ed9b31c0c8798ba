/*
 * A write takes 3.4 ms, and simavr 1.6 no time: EEPE stays set, and a power cycle in that time leaves junk in the cell,
 * or what the fault specifies.
 */
#include "simrun_eeprom.h"

#include <string.h>

#include "avr_eeprom.h"
#include "simrun_events.h"
#include "simrun_mcu.h"
#include "simrun_output.h"
#include "simrun_resets.h"

enum {
    REG_EECR = 0x3F,
    REG_EEARL = 0x41,
    REG_EEARH = 0x42,
    BIT_EEPE = 0x02,
    BIT_EEMPE = 0x04,
    EEPROM_BYTES = 1024,
    WRITE_US = 3400
};

static avr_eeprom_t *eeprom;
static const char *file_path;
static void (*on_write)(uint32_t count, eeprom_moment_t moment);
static avr_io_write_t core_write;
static void *core_param;
static uint64_t busy_until = NEVER;
static uint16_t busy_address;
static uint8_t cell_before;
static eeprom_left_t left = EEPROM_LEFT_RANDOM;
static uint32_t write_count;
static uint32_t cell_writes[EEPROM_BYTES];

static void on_control(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    (void)param;
    if (busy_until != NEVER) { /* no second write, and EEPE cannot be cleared */
        core_write(avr, address, value & (uint8_t) ~(BIT_EEPE | BIT_EEMPE), core_param);
        avr->data[REG_EECR] |= BIT_EEPE;
        return;
    }
    bool writes = (value & BIT_EEPE) != 0 && (avr->data[REG_EECR] & BIT_EEMPE) != 0;
    if (writes) {
        on_write(++write_count, EEPROM_BEFORE);
        if (resets_wanted()) { /* the reset comes before the write */
            core_write(avr, address, value & (uint8_t) ~(BIT_EEPE | BIT_EEMPE), core_param);
            return;
        }
        busy_address = (uint16_t)((avr->data[REG_EEARL] | (unsigned)avr->data[REG_EEARH] << 8) % EEPROM_BYTES);
        cell_before = eeprom->eeprom[busy_address];
        cell_writes[busy_address]++;
    }
    core_write(avr, address, value, core_param);
    if (writes) {
        busy_until = avr->cycle + (uint64_t)WRITE_US * CYCLES_PER_US;
        avr->data[REG_EECR] |= BIT_EEPE;
        events_reschedule();
        on_write(write_count, EEPROM_IN);
    }
}

uint64_t eeprom_next(void)
{
    return busy_until;
}

void eeprom_step(void)
{
    busy_until = NEVER;
    mcu->data[REG_EECR] &= (uint8_t)~BIT_EEPE;
    on_write(write_count, EEPROM_AFTER);
}

void eeprom_leave(eeprom_left_t what)
{
    left = what;
}

static uint8_t what_is_left(void)
{
    switch (left) {
    case EEPROM_LEFT_FF:
        return 0xFF;
    case EEPROM_LEFT_OLD:
        return cell_before;
    case EEPROM_LEFT_NEW:
        return eeprom->eeprom[busy_address];
    default:
        return (uint8_t)mcu_random();
    }
}

/* A reset lets a write finish (data sheet, "EEPROM Write"); without power the cell is left half written. */
void eeprom_reset(bool power_lost)
{
    if (busy_until == NEVER) {
        return;
    }
    if (power_lost) {
        eeprom->eeprom[busy_address] = what_is_left();
        busy_until = NEVER;
    } else {
        mcu->data[REG_EECR] |= BIT_EEPE;
    }
}

void eeprom_on_write(void (*act)(uint32_t count, eeprom_moment_t moment))
{
    on_write = act;
}

void eeprom_start(const char *path)
{
    file_path = path;
    for (avr_io_t *io = mcu->io_port; io != NULL; io = io->next) {
        if (strcmp(io->kind, "eeprom") == 0) {
            eeprom = (avr_eeprom_t *)io;
        }
    }
    core_write = mcu->io[AVR_DATA_TO_IO(REG_EECR)].w.c;
    core_param = mcu->io[AVR_DATA_TO_IO(REG_EECR)].w.param;
    mcu->io[AVR_DATA_TO_IO(REG_EECR)].w.c = on_control;
    FILE *file = path == NULL ? NULL : fopen(path, "rb");
    if (file == NULL) {
        return;
    }
    uint8_t contents[EEPROM_BYTES + 1];
    size_t length = fread(contents, 1, sizeof contents, file);
    if (ferror(file) || length > EEPROM_BYTES) {
        output_refuse("%s: %s", path, ferror(file) ? "cannot read" : "longer than 1024 bytes");
    }
    fclose(file);
    memcpy(eeprom->eeprom, contents, length);
}

void eeprom_print(FILE *json)
{
    uint32_t most = 0;
    for (unsigned i = 0; i < EEPROM_BYTES; i++) {
        most = cell_writes[i] > most ? cell_writes[i] : most;
    }
    fprintf(json, "  \"eeprom_writes\": %u,\n  \"eeprom_cell_writes_max\": %u,\n", (unsigned)write_count,
            (unsigned)most);
}

void eeprom_finish(void)
{
    if (file_path == NULL) {
        return;
    }
    FILE *file = output_open(file_path);
    fwrite(eeprom->eeprom, 1, EEPROM_BYTES, file);
    output_close(file, file_path);
}
