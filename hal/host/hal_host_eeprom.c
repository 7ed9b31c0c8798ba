/*
 * The host's EEPROM: 3.4 ms per write, as on the chip, and the effects of supply and wear. Tests cut a write, wear out
 * a cell, and read how often each cell was written.
 */
#include <string.h>

#include "hal_eeprom.h"
#include "hal_host_private.h"

enum { WRITE_US = 3400, POLL_CYCLES = HOST_CYCLES_PER_US };

static uint8_t cells[HAL_EEPROM_SIZE];
static uint32_t writes[HAL_EEPROM_SIZE];
static uint64_t ready_at;
static uint16_t worn;
static struct {
    uint32_t writes_left; /* until the cut, that write included; 0: no cut is due */
    hal_host_left_t left;
    uint8_t value;
    bool came;
} cut;

void host_eeprom_power_on(void)
{
    memset(cells, 0xFF, sizeof cells);
    memset(writes, 0, sizeof writes);
    memset(&cut, 0, sizeof cut);
    worn = HAL_EEPROM_SIZE;
    ready_at = 0;
}

/* A write continues across a reset, but not across a power loss. */
void host_eeprom_reset(void)
{
    if (cut.came) {
        cut.came = false;
        ready_at = 0;
    }
}

uint8_t *hal_host_eeprom(void)
{
    return cells;
}

void hal_host_eeprom_cut(uint32_t nth, hal_host_left_t left, uint8_t value)
{
    cut.writes_left = nth;
    cut.left = left;
    cut.value = value;
}

bool hal_host_eeprom_was_cut(void)
{
    return cut.came;
}

void hal_host_eeprom_wear_out(uint16_t address)
{
    worn = address;
}

uint32_t hal_host_eeprom_writes(uint16_t address)
{
    return writes[address];
}

/* Polling reaches the end of the write, although main does not sleep. */
bool hal_eeprom_ready(void)
{
    if (cut.came) {
        return false;
    }
    if (hal_host_now() >= ready_at) {
        return true;
    }
    host_clock_spend(POLL_CYCLES);
    return false;
}

uint8_t hal_eeprom_read(uint16_t address)
{
    return cells[address % HAL_EEPROM_SIZE];
}

/* The cell's content after the write. */
static uint8_t outcome(uint16_t address, uint8_t value)
{
    if (address == worn) {
        return cells[address];
    }
    if (!cut.came) {
        return value;
    }
    const uint8_t left[] = { [HAL_HOST_LEFT_OLD] = cells[address],
                             [HAL_HOST_LEFT_NEW] = value,
                             [HAL_HOST_LEFT_ERASED] = 0xFF,
                             [HAL_HOST_LEFT_VALUE] = cut.value };
    return left[cut.left];
}

void hal_eeprom_write_start(uint16_t address, uint8_t value)
{
    address %= HAL_EEPROM_SIZE;
    if (cut.came) {
        return;
    }
    cut.came = cut.writes_left == 1;
    cut.writes_left -= cut.writes_left != 0 ? 1u : 0u;
    writes[address]++;
    cells[address] = outcome(address, value);
    ready_at = hal_host_now() + (uint64_t)WRITE_US * HOST_CYCLES_PER_US;
}
