/* The EEPROM store when the supply goes, cells wear out and others meddle: always a whole set, the old or the new. */
#include "hal_eeprom.h"
#include "hal_host.h"
#include "hal_time.h"
#include "hal_watchdog.h"
#include "support/random.h"
#include "support/store.h"
#include "support/test.h"

enum { OLD = 3, NEW = 200, THIRD = 77, NONE = -1 };

static uint8_t before[HAL_EEPROM_SIZE];

void setUp(void)
{
    store_new_board();
}

static void saves(int count)
{
    for (int i = 1; i <= count; i++) {
        store_save(i == count ? OLD : (uint32_t)(OLD + 50 + i % 100));
        TEST_ASSERT_FALSE(store_failed());
    }
}

/* What the EEPROM went through before; the set in force then, or NONE. */
static int live(int history)
{
    store_new_board();
    (void)store_boot();
    switch (history) {
    case 0:
        return NONE;
    case 1: /* one copy */
    case 2: /* two */
    case 3:
        saves(history);
        return OLD;
    case 4: /* both parities of the wrap of the sequence number */
    case 5:
        saves(123 + history);
        return OLD;
    case 6: /* the other copy is damaged in its mark, and so that it may come right */
        saves(2);
        store_copy(0)[STORE_AT_MARK] ^= 1u;
        return OLD;
    case 7: /* a save that was cut in its body */
        saves(2);
        hal_host_eeprom_cut(20, HAL_HOST_LEFT_VALUE, 0x5A);
        store_save(THIRD);
        return OLD;
    case 8: /* both copies of another version */
        store_forge(0, OLD, STORE_VERSION + 1, 5);
        store_forge(1, OLD, STORE_VERSION + 1, 6);
        return NONE;
    default: /* one of each, ours the older */
        store_forge(0, OLD, STORE_VERSION, 5);
        store_forge(1, THIRD, STORE_VERSION + 1, 6);
        return OLD;
    }
}

enum { HISTORIES = 10 };

/* Boots from what was kept and saves; the Nth write is cut. Returns whether there was one. */
static bool cut_save(uint32_t set, uint32_t nth, hal_host_left_t left, uint8_t value)
{
    store_put_back(before);
    (void)store_boot();
    hal_host_eeprom_cut(nth, left, value);
    store_save(set);
    bool came = hal_host_eeprom_was_cut();
    hal_host_eeprom_cut(0, left, value);
    return came;
}

/* Boots after a cut: a whole set, and the next save gets through. Returns whether it was the new set. */
static bool judge_boot(int old, uint32_t set)
{
    store_status_t status = store_boot();
    bool is_new = status >= STORE_GOOD && store_holds(set);
    if (!is_new && old == NONE) {
        TEST_ASSERT_TRUE(status < STORE_GOOD);
    } else if (!is_new) {
        TEST_ASSERT_TRUE(status >= STORE_GOOD);
        TEST_ASSERT_TRUE(store_holds((uint32_t)old));
    }
    store_save(THIRD);
    TEST_ASSERT_FALSE(store_failed());
    store_boots_to(STORE_GOOD, THIRD);
    return is_new;
}

/* Before the write the set is the old one until its last, after it the new one from its last on. */
static uint32_t cut_everywhere(int old, uint32_t set, int values)
{
    uint32_t nth = 1;
    for (; cut_save(set, nth, HAL_HOST_LEFT_OLD, 0); nth++) {
        TEST_ASSERT_FALSE_MESSAGE(judge_boot(old, set), "cut before a write");
        (void)cut_save(set, nth, HAL_HOST_LEFT_ERASED, 0);
        TEST_ASSERT_FALSE_MESSAGE(judge_boot(old, set), "an erased byte");
        for (int value = 0; value < values; value++) {
            (void)cut_save(set, nth, HAL_HOST_LEFT_VALUE, (uint8_t)value);
            (void)judge_boot(old, set);
        }
        uint32_t writes = store_writes();
        (void)cut_save(set, nth, HAL_HOST_LEFT_NEW, 0);
        writes = store_writes() - writes;
        TEST_ASSERT_EQUAL_UINT32(nth, writes);
        bool last = !cut_save(set, nth + 1, HAL_HOST_LEFT_OLD, 0);
        (void)cut_save(set, nth, HAL_HOST_LEFT_NEW, 0);
        TEST_ASSERT_EQUAL_MESSAGE(last, judge_boot(old, set), "cut after a write");
    }
    TEST_ASSERT_FALSE(store_failed());
    return nth - 1;
}

/* All bytes differ: those of the image, mark twice, sequence number, two checks at most, and the version once. */
TEST(test_supply_cut_at_every_byte_of_a_save)
{
    for (int history = 0; history < HISTORIES; history++) {
        int old = live(history);
        store_keep(before);
        uint32_t writes = cut_everywhere(old, NEW, 256);
        TEST_ASSERT_TRUE(writes >= STORE_IMAGE_SIZE && writes <= STORE_IMAGE_SIZE + 6u);
    }
}

TEST(test_supply_cut_in_a_save_of_one_changed_byte)
{
    for (int history = 1; history < 6; history++) {
        int old = live(history);
        store_save(OLD); /* both copies alike */
        store_keep(before);
        TEST_ASSERT_TRUE(cut_everywhere(old, OLD + 256, 256) <= 6);
    }
}

static const hal_host_left_t lefts[] = { HAL_HOST_LEFT_OLD, HAL_HOST_LEFT_NEW, HAL_HOST_LEFT_ERASED,
                                         HAL_HOST_LEFT_VALUE };

/* A cut in a save of NEW, then one in a save of OTHER; what counts then is whole, and one that may. */
static void cut_twice(int old, uint32_t first, test_random_t *random)
{
    enum { OTHER = 100 };
    store_put_back(before);
    (void)cut_save(NEW, first, lefts[random_below(random, 4)], (uint8_t)random_u32(random));
    bool was_new = store_boot() >= STORE_GOOD && store_holds(NEW);
    hal_host_eeprom_cut(1 + random_below(random, STORE_IMAGE_SIZE + 6u), lefts[random_below(random, 4)],
                        (uint8_t)random_u32(random));
    store_save(OTHER);
    hal_host_eeprom_cut(0, HAL_HOST_LEFT_OLD, 0);
    if (store_boot() < STORE_GOOD) {
        TEST_ASSERT_TRUE(old == NONE && !was_new);
    } else {
        TEST_ASSERT_TRUE(store_holds(OTHER) || store_holds(NEW) || (old != NONE && !was_new && store_holds(OLD)));
    }
    store_save(THIRD);
    store_boots_to(STORE_GOOD, THIRD);
}

TEST(test_supply_cut_in_the_save_after_one_that_was_cut)
{
    test_random_t random;
    random_seed(&random, 11);
    for (int history = 0; history < HISTORIES; history++) {
        int old = live(history);
        store_keep(before);
        for (uint32_t first = 1; first <= STORE_IMAGE_SIZE + 6u; first++) {
            for (int i = 0; i < 200; i++) {
                cut_twice(old, first, &random);
            }
        }
    }
}

/* The number wraps twice, and each set is the one in force after its save. */
TEST(test_three_hundred_saves_on_end)
{
    TEST_ASSERT_EQUAL(STORE_EMPTY, store_boot());
    for (uint32_t i = 0; i < 300; i++) {
        store_save(i % 256);
        store_boots_to(STORE_GOOD, i % 256);
        TEST_ASSERT_EQUAL_UINT8(i % 128, store_copy((int)(i % 2))[STORE_AT_SEQUENCE]);
    }
    /* 150 saves each, which open and close it, but the first, which finds it open */
    TEST_ASSERT_EQUAL_UINT32(299, hal_host_eeprom_writes(STORE_COPY_0 + STORE_AT_MARK));
    TEST_ASSERT_EQUAL_UINT32(299, hal_host_eeprom_writes(STORE_COPY_1 + STORE_AT_MARK));
}

/* The later of two neighbours counts, in either copy; of two with one number either, and then what is saved next. */
TEST(test_every_sequence_number)
{
    for (unsigned n = 0; n < 128; n++) {
        for (int later = 0; later < 2; later++) {
            store_forge(later, NEW, STORE_VERSION, (uint8_t)((n + 1) % 128));
            store_forge(1 - later, OLD, STORE_VERSION, (uint8_t)n);
            store_boots_to(STORE_GOOD, NEW);
        }
        store_forge(0, OLD, STORE_VERSION, (uint8_t)n);
        TEST_ASSERT_EQUAL(STORE_GOOD, store_boot());
        TEST_ASSERT_TRUE(store_holds(OLD) || store_holds(NEW));
    }
    store_forge(0, OLD, STORE_VERSION, 9);
    store_forge(1, NEW, STORE_VERSION, 9);
    (void)store_boot();
    store_save(THIRD);
    store_boots_to(STORE_GOOD, THIRD);
}

/*
 * What a save of one byte's change writes: the mark twice, the number, the byte, and those of the two checks that
 * become others. Nothing else, and nothing outside the copy.
 */
TEST(test_cells_written_for_one_changed_byte)
{
    (void)store_boot();
    saves(3);
    store_save(OLD); /* copies alike but for their numbers: 2 and 3 */
    uint8_t expected[HAL_EEPROM_SIZE] = { 0 };
    uint8_t old[STORE_RECORD_SIZE];
    for (unsigned i = 0; i < STORE_RECORD_SIZE; i++) {
        old[i] = store_copy(0)[i];
    }
    store_forge(0, OLD + 256, STORE_VERSION, 4);
    for (unsigned i = 0; i < STORE_AT_MARK; i++) {
        expected[STORE_COPY_0 + i] = store_copy(0)[i] != old[i];
        store_copy(0)[i] = old[i];
    }
    expected[STORE_COPY_0 + STORE_AT_MARK] = 2;
    TEST_ASSERT_EQUAL_UINT8(1, expected[STORE_COPY_0 + OLD]);
    uint32_t was[HAL_EEPROM_SIZE];
    for (uint16_t a = 0; a < HAL_EEPROM_SIZE; a++) {
        was[a] = hal_host_eeprom_writes(a);
    }
    store_save(OLD + 256);
    for (uint16_t a = 0; a < HAL_EEPROM_SIZE; a++) {
        TEST_ASSERT_EQUAL_UINT32(expected[a], hal_host_eeprom_writes(a) - was[a]);
    }
}

/* A cell that does not take its byte: the save fails and is told, the old set stays; and after many, one that works. */
TEST(test_worn_cell)
{
    for (uint16_t place = 0; place < STORE_RECORD_SIZE; place++) {
        (void)live(3);
        hal_host_eeprom_wear_out((uint16_t)(STORE_COPY_1 + place));
        bool fails = place != STORE_AT_VERSION;
        for (int i = 0; i < 100; i++) {
            store_save(NEW);
            TEST_ASSERT_EQUAL(fails, store_failed());
            if (!fails) {
                break;
            }
        }
        hal_host_eeprom_wear_out(HAL_EEPROM_SIZE);
        store_keep(before);
        if (fails) {
            TEST_ASSERT_TRUE(store_boot() >= STORE_GOOD);
            TEST_ASSERT_TRUE(store_holds(OLD));
            store_put_back(before);
        }
        store_save(THIRD);
        TEST_ASSERT_FALSE(store_failed());
        store_boots_to(STORE_GOOD, THIRD);
    }
}

/* A save that failed, a load, a save: what it wrote is the later one. */
TEST(test_load_after_a_save_that_failed)
{
    for (int history = 2; history < 4; history++) {
        (void)live(history);
        hal_host_eeprom_wear_out((uint16_t)(history == 2 ? STORE_COPY_0 : STORE_COPY_1));
        store_save(NEW);
        TEST_ASSERT_TRUE(store_failed());
        hal_host_eeprom_wear_out(HAL_EEPROM_SIZE);
        TEST_ASSERT_EQUAL(STORE_OTHER_COPY, store_load(store_record));
        TEST_ASSERT_FALSE(store_failed());
        store_save(NEW);
        store_boots_to(STORE_GOOD, NEW);
    }
}

/* The image changes after any pass of a save, but the last that writes: failed, and the old set stays. */
TEST(test_image_that_changes_during_a_save)
{
    for (unsigned after = 0; after < STORE_RECORD_SIZE; after++) {
        for (unsigned place = 0; place < STORE_IMAGE_SIZE; place += 7) {
            (void)live(3);
            store_fill(NEW);
            TEST_ASSERT_TRUE(store_save_begin());
            for (unsigned i = 0; i < after;) {
                i += store_pass() ? 1 : 0;
                while (!hal_eeprom_ready()) {
                }
            }
            store_record[place] ^= 0x10u;
            store_finish();
            TEST_ASSERT_TRUE(store_failed());
            store_boots_to(STORE_OTHER_COPY, OLD);
        }
    }
}

/* One write begun in a call at most, none while the EEPROM is not ready, and no second save beside the first. */
TEST(test_one_byte_at_a_time)
{
    (void)live(3);
    store_fill(NEW);
    TEST_ASSERT_FALSE(store_busy());
    TEST_ASSERT_TRUE(store_save_begin());
    while (store_busy()) {
        TEST_ASSERT_FALSE(store_save_begin());
        uint32_t writes = store_writes();
        bool more = store_pass();
        TEST_ASSERT_TRUE(store_writes() - writes <= 1);
        if (store_writes() != writes) {
            TEST_ASSERT_FALSE(more);
            TEST_ASSERT_FALSE(store_pass());
            TEST_ASSERT_EQUAL_UINT32(writes + 1, store_writes());
            while (!hal_eeprom_ready()) {
            }
        }
    }
    TEST_ASSERT_FALSE(store_pass());
    store_boots_to(STORE_GOOD, NEW);
}

/* A reset by the watchdog leaves the write under way: it is waited for, and not read before. */
TEST(test_reset_during_a_write)
{
    (void)live(2);
    store_fill(NEW);
    (void)store_save_begin();
    TEST_ASSERT_FALSE(store_pass());
    double begun_ms = hal_host_now_ms();
    hal_host_reset_mcu(HAL_RESET_WATCHDOG);
    TEST_ASSERT_FALSE(hal_eeprom_ready());
    TEST_ASSERT_EQUAL(STORE_OTHER_COPY, store_load(store_record));
    TEST_ASSERT_TRUE(store_holds(OLD));
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 3.4, hal_host_now_ms() - begun_ms);
}
