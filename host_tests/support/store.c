#include "support/store.h"

#include <string.h>

#include "hal_eeprom.h"
#include "hal_host.h"
#include "hal_sleep.h"
#include "hal_time.h"
#include "hal_watchdog.h"

uint8_t store_record[STORE_RECORD_SIZE];

void store_new_board(void)
{
    hal_host_config_t config = { .time_start_us = 0 };
    hal_host_begin(&config, NULL, false);
}

store_status_t store_boot(void)
{
    hal_host_reset_mcu(HAL_RESET_POWER_ON);
    hal_time_init();
    memset(store_record, 0xA7, sizeof store_record);
    return store_load(store_record);
}

/* Sets 0..255 differ from each other in every byte; 256 + n differs from n in byte n % STORE_IMAGE_SIZE alone. */
static uint8_t byte_of_set(uint32_t set, unsigned i)
{
    bool other = set >= 256 && i == set % 256 % STORE_IMAGE_SIZE;
    return (uint8_t)((uint8_t)(set * 29u) ^ (uint8_t)(i * 83u) ^ (other ? 0x40u : 0u));
}

void store_fill(uint32_t set)
{
    for (unsigned i = 0; i < STORE_IMAGE_SIZE; i++) {
        store_record[i] = byte_of_set(set, i);
    }
}

bool store_holds(uint32_t set)
{
    for (unsigned i = 0; i < STORE_IMAGE_SIZE; i++) {
        if (store_record[i] != byte_of_set(set, i)) {
            return false;
        }
    }
    return true;
}

void store_finish(void)
{
    while (store_busy() && !hal_host_eeprom_was_cut()) {
        if (!store_pass()) {
            hal_sleep_until_wake();
        }
    }
}

void store_save(uint32_t set)
{
    store_fill(set);
    (void)store_save_begin();
    store_finish();
}

uint8_t *store_copy(int copy)
{
    return hal_host_eeprom() + (copy == 0 ? STORE_COPY_0 : STORE_COPY_1);
}

void store_keep(uint8_t kept[HAL_EEPROM_SIZE])
{
    memcpy(kept, hal_host_eeprom(), HAL_EEPROM_SIZE);
}

void store_put_back(const uint8_t kept[HAL_EEPROM_SIZE])
{
    memcpy(hal_host_eeprom(), kept, HAL_EEPROM_SIZE);
}

uint32_t store_writes(void)
{
    uint32_t sum = 0;
    for (uint16_t a = 0; a < HAL_EEPROM_SIZE; a++) {
        sum += hal_host_eeprom_writes(a);
    }
    return sum;
}

/* Carry-less, reduced by x^8 + x^4 + x^3 + x^2 + 1 at each doubling. */
uint8_t store_times_power(uint8_t a, unsigned n)
{
    unsigned product = a;
    for (; n != 0; n--) {
        product = product * 2u;
        product ^= product >= 256u ? 0x11Du : 0u;
    }
    return (uint8_t)product;
}

/*
 * With the checks p (times 2) and q, the sum of all bytes and that of byte k from the end times 2^k are 0: p + q = s,
 * 2p + q = w, so 3p = s + w. 3 = 2^25 in this field, so one third is 2^230.
 */
void store_seal(uint8_t *record)
{
    uint8_t sum = 0;
    uint8_t weighted = 0;
    for (unsigned i = 0; i < STORE_AT_CHECK; i++) {
        sum ^= record[i];
        weighted ^= store_times_power(record[i], STORE_AT_CHECK + 1u - i);
    }
    uint8_t p = store_times_power(sum ^ weighted, 255 - 25);
    record[STORE_AT_CHECK] = p;
    record[STORE_AT_CHECK + 1] = p ^ sum;
}

void store_forge(int copy, uint32_t set, uint8_t version, uint8_t sequence)
{
    uint8_t *at = store_copy(copy);
    for (unsigned i = 0; i < STORE_IMAGE_SIZE; i++) {
        at[i] = byte_of_set(set, i);
    }
    at[STORE_AT_VERSION] = version;
    at[STORE_AT_SEQUENCE] = sequence;
    store_seal(at);
    at[STORE_AT_MARK] = STORE_IMAGE_SIZE;
}
