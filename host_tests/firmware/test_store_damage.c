/* Damaged copies of the EEPROM store: the other copy or the caller's defaults, and the status that says so. */
#include <string.h>

#include "hal_eeprom.h"
#include "hal_host.h"
#include "support/random.h"
#include "support/store.h"
#include "support/test.h"

enum { OLDER = 40, LATEST = 41 };

static uint8_t whole[HAL_EEPROM_SIZE];

/* The older set in copy 0, the latest in copy 1; the numbers before the wrap. */
void setUp(void)
{
    store_new_board();
    (void)store_boot();
    store_forge(0, 7, STORE_VERSION, 125);
    store_forge(1, 8, STORE_VERSION, 126);
    (void)store_boot();
    store_save(OLDER);
    store_save(LATEST);
    store_keep(whole);
}

/* What is left when this copy alone is damaged. */
static void boots_without(int copy)
{
    store_boots_to(STORE_OTHER_COPY, copy == 0 ? LATEST : OLDER);
}

/* The twin of all that follows: undamaged; and the store seals a copy as another way of reckoning does. */
TEST(test_undamaged)
{
    store_boots_to(STORE_GOOD, LATEST);
    for (int copy = 0; copy < 2; copy++) {
        store_forge(copy, copy == 0 ? OLDER : LATEST, STORE_VERSION, copy == 0 ? 127 : 0);
    }
    TEST_ASSERT_EQUAL_UINT8_ARRAY(whole, hal_host_eeprom(), HAL_EEPROM_SIZE);
}

TEST(test_every_byte_of_a_copy_with_every_value)
{
    for (int copy = 0; copy < 2; copy++) {
        for (unsigned place = 0; place < STORE_RECORD_SIZE; place++) {
            for (unsigned damage = 1; damage < 256; damage++) {
                store_copy(copy)[place] ^= (uint8_t)damage;
                boots_without(copy);
                store_copy(copy)[place] ^= (uint8_t)damage;
            }
        }
    }
    store_boots_to(STORE_GOOD, LATEST);
}

enum { WAYS = 24 };

/* In ways 0 to 7 a flipped bit, then 00 and FF, else anything; always another value. */
static uint8_t damaged(uint8_t value, int way, test_random_t *random)
{
    uint8_t other = (uint8_t)(value ^ 1u << way % 8);
    if (way == 8 || way == 9) {
        other = way == 8 ? 0x00 : 0xFF;
    } else if (way > 9) {
        other = (uint8_t)(value + 1u + random_below(random, 255));
    }
    return other != value ? other : (uint8_t)~value;
}

static void damage_two(int copy, unsigned first, unsigned second, int way, test_random_t *random)
{
    uint8_t *at = store_copy(copy);
    at[first] = damaged(at[first], way, random);
    at[second] = damaged(at[second], way, random);
}

TEST(test_every_pair_of_bytes_of_a_copy)
{
    test_random_t random;
    random_seed(&random, 21);
    for (int copy = 0; copy < 2; copy++) {
        for (unsigned first = 0; first < STORE_RECORD_SIZE; first++) {
            for (unsigned second = first + 1; second < STORE_RECORD_SIZE; second++) {
                for (int way = 0; way < WAYS; way++) {
                    damage_two(copy, first, second, way, &random);
                    boots_without(copy);
                    store_put_back(whole);
                }
            }
        }
    }
}

/* A byte in each. */
TEST(test_every_byte_of_one_with_every_byte_of_the_other)
{
    test_random_t random;
    random_seed(&random, 22);
    for (unsigned first = 0; first < STORE_RECORD_SIZE; first++) {
        for (unsigned second = 0; second < STORE_RECORD_SIZE; second++) {
            for (int way = 0; way < WAYS; way++) {
                store_copy(0)[first] = damaged(store_copy(0)[first], way, &random);
                store_copy(1)[second] = damaged(store_copy(1)[second], way, &random);
                store_boots_to(STORE_DAMAGED, 0);
                store_put_back(whole);
            }
        }
    }
}

/* Two bytes in each: every pair, the same in both and with one at random. All FF is not told as never saved. */
TEST(test_every_pair_of_bytes_of_both)
{
    test_random_t random;
    random_seed(&random, 23);
    for (unsigned first = 0; first < STORE_RECORD_SIZE; first++) {
        for (unsigned second = first + 1; second < STORE_RECORD_SIZE; second++) {
            for (int way = 0; way < WAYS; way++) {
                unsigned a = random_below(&random, STORE_RECORD_SIZE - 1);
                unsigned b = a + 1 + random_below(&random, STORE_RECORD_SIZE - 1 - a);
                bool same = way < 12;
                damage_two(0, first, second, way, &random);
                damage_two(1, same ? first : a, same ? second : b, way, &random);
                store_boots_to(STORE_DAMAGED, 0);
                store_put_back(whole);
            }
        }
    }
}

/*
 * Every pair of damages, all values: bytes k and 0 from the end of what the check is over. The check is linear and its
 * two sums weigh neighbours alike at every place, so this is every pair of places. A pair that went unseen would leave
 * both sums as they were.
 */
TEST(test_no_pair_of_damages_leaves_the_check_right)
{
    unsigned long seen = 0;
    for (unsigned k = 1; k < STORE_IMAGE_MAX + 4u; k++) {
        for (unsigned d = 1; d < 256; d++) {
            unsigned shifted = store_times_power((uint8_t)d, k);
            for (unsigned e = 1; e < 256; e++) {
                seen += d != e || shifted != e;
            }
        }
    }
    TEST_ASSERT_EQUAL_UINT32((STORE_IMAGE_MAX + 3u) * 255u * 255u, seen);
}

/* Any bytes at all under a mark that is right: taken once in 65,536 times. */
TEST(test_junk_under_a_right_mark)
{
    test_random_t random;
    random_seed(&random, 24);
    unsigned taken = 0;
    for (int i = 0; i < 20000; i++) {
        for (unsigned place = 0; place < STORE_AT_MARK; place++) {
            store_copy(0)[place] = (uint8_t)random_u32(&random);
            store_copy(1)[place] = (uint8_t)random_u32(&random);
        }
        taken += store_boot() != STORE_DAMAGED;
    }
    TEST_ASSERT_TRUE_MESSAGE(taken <= 4, "40,000 copies, 0.6 to be expected: five or more for one seed in 2,400");
}

/* Contents that programs and programmers leave: all 00 and any one value are not ours, all FF is an empty store. */
TEST(test_contents_of_one_value)
{
    for (unsigned value = 0; value < 256; value++) {
        memset(hal_host_eeprom(), (int)value, HAL_EEPROM_SIZE);
        store_boots_to(value == 0xFF ? STORE_EMPTY : STORE_DAMAGED, 0);
    }
}

TEST(test_one_copy_never_written)
{
    memset(store_copy(0), 0xFF, STORE_RECORD_SIZE);
    store_boots_to(STORE_GOOD, LATEST);
    store_copy(1)[3] ^= 1u;
    store_boots_to(STORE_DAMAGED, 0);
    store_save(OLDER);
    store_boots_to(STORE_GOOD, OLDER);
}

/* Damaged, then saved: whole again after one save where one was damaged, after two where both were. */
TEST(test_a_save_heals)
{
    for (int copy = 0; copy < 2; copy++) {
        store_put_back(whole);
        store_copy(copy)[STORE_AT_MARK] ^= 4u;
        (void)store_boot();
        store_save(99);
        store_boots_to(STORE_GOOD, 99);
    }
    store_copy(0)[0] ^= 4u;
    store_copy(1)[0] ^= 4u;
    store_boots_to(STORE_DAMAGED, 0);
    store_save(98);
    store_boots_to(STORE_OTHER_COPY, 98);
    store_save(97);
    store_boots_to(STORE_GOOD, 97);
}

/* Another version is told when a copy of it is whole, and never when it only looks like it. Ours comes first. */
TEST(test_other_version)
{
    store_forge(0, OLDER, STORE_VERSION + 1, 127);
    store_boots_to(STORE_GOOD, LATEST);
    store_forge(1, LATEST, STORE_VERSION + 1, 0);
    store_boots_to(STORE_OTHER_VERSION, 0);
    store_copy(1)[STORE_AT_VERSION] = STORE_VERSION;
    store_boots_to(STORE_OTHER_VERSION, 0);
    store_copy(0)[STORE_AT_VERSION] = STORE_VERSION + 3;
    store_boots_to(STORE_DAMAGED, 0);
    store_forge(0, OLDER, STORE_VERSION, 50);
    store_forge(1, LATEST, STORE_VERSION + 1, 51);
    store_boots_to(STORE_GOOD, OLDER);
}

/* Records of another size: whatever it says of itself, what stands where we look is not ours. */
TEST(test_other_size)
{
    for (unsigned mark = 0; mark < 256; mark++) {
        store_put_back(whole);
        if (mark != STORE_IMAGE_SIZE) {
            store_copy(1)[STORE_AT_MARK] = (uint8_t)mark;
            store_boots_to(STORE_OTHER_COPY, OLDER);
        }
    }
}
