/*
 * The store (store.h) over the EEPROM of the host, and its check worked out in another way: by the two sums
 * over the bytes of a record that the zeros of the polynomial, 1 and 2, make 0.
 */
#ifndef SUPPORT_STORE_H
#define SUPPORT_STORE_H

#include <stdbool.h>
#include <stdint.h>

#include "settings/store.h"
#include "support/test.h"

/* Places behind the image, as store.h orders its tail. */
enum { STORE_AT_VERSION = STORE_IMAGE_SIZE, STORE_AT_SEQUENCE, STORE_AT_CHECK, STORE_AT_MARK = STORE_RECORD_SIZE - 1 };

extern uint8_t store_record[STORE_RECORD_SIZE];

/* A new board; the supply comes, the record holds junk before it is loaded. */
void store_new_board(void);
store_status_t store_boot(void);

/* Sets: any number names one, no two agree in a byte that differs by the number's low bits. */
void store_fill(uint32_t set);
bool store_holds(uint32_t set);

/* A boot that ends in this status, and with this set where one is good. */
static inline void store_boots_to(store_status_t expected, uint32_t set)
{
    TEST_ASSERT_EQUAL(expected, store_boot());
    TEST_ASSERT_TRUE(expected < STORE_GOOD || store_holds(set));
}

/* Fills, begins, and passes until it is over or the supply goes. The second without the first two. */
void store_save(uint32_t set);
void store_finish(void);

uint8_t *store_copy(int copy);
void store_keep(uint8_t kept[1024]);
void store_put_back(const uint8_t kept[1024]);
uint32_t store_writes(void);

/* a times 2 to the n; the two check bytes that belong to the bytes before them. */
uint8_t store_times_power(uint8_t a, unsigned n);
void store_seal(uint8_t *record);

/* A copy that says all that of itself. */
void store_forge(int copy, uint32_t set, uint8_t version, uint8_t sequence);

#endif
