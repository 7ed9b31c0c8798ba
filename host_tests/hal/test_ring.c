/* The byte ring of the UART: fill, wrap, overflow, staged bytes, every position of the indices. */
#include "hal_ring.h"
#include "support/test.h"

enum { SIZE = 16, MASK = SIZE - 1 };

static uint8_t buffer[SIZE];
static hal_ring_t ring;

void setUp(void)
{
    ring = (hal_ring_t){ 0, 0, 0 };
}

static void start_at(uint8_t index)
{
    ring = (hal_ring_t){ index, index, index };
}

TEST(test_room_and_order_at_every_position)
{
    for (uint8_t start = 0; start < SIZE; start++) {
        start_at(start);
        for (uint8_t n = 0; n < SIZE - 1; n++) {
            TEST_ASSERT_EQUAL_UINT8(SIZE - 1 - n, hal_ring_room(&ring, MASK));
            hal_ring_stage(&ring, buffer, MASK, (uint8_t)(n + 100u));
        }
        TEST_ASSERT_EQUAL_UINT8(0, hal_ring_room(&ring, MASK));
        hal_ring_commit(&ring);
        for (uint8_t n = 0; n < SIZE - 1; n++) {
            TEST_ASSERT_FALSE(hal_ring_empty(&ring));
            TEST_ASSERT_EQUAL_UINT8(n + 100u, hal_ring_take(&ring, buffer, MASK));
        }
        TEST_ASSERT_TRUE(hal_ring_empty(&ring));
    }
}

TEST(test_staged_bytes_are_invisible_until_committed)
{
    start_at(SIZE - 1);
    hal_ring_stage(&ring, buffer, MASK, 1);
    TEST_ASSERT_TRUE(hal_ring_empty(&ring));
    hal_ring_commit(&ring);
    TEST_ASSERT_FALSE(hal_ring_empty(&ring));
}

TEST(test_discard_takes_back_only_what_is_staged)
{
    start_at(3);
    hal_ring_stage(&ring, buffer, MASK, 7);
    hal_ring_commit(&ring);
    hal_ring_stage(&ring, buffer, MASK, 8);
    hal_ring_discard(&ring);
    TEST_ASSERT_EQUAL_UINT8(SIZE - 2, hal_ring_room(&ring, MASK));
    TEST_ASSERT_EQUAL_UINT8(7, hal_ring_take(&ring, buffer, MASK));
    TEST_ASSERT_TRUE(hal_ring_empty(&ring));
}

/* The transmit ring has 256 slots: the mask is all ones and the indices wrap by themselves. */
TEST(test_ring_of_256)
{
    static uint8_t big[256];
    start_at(250);
    for (unsigned n = 0; n < 255; n++) {
        hal_ring_stage(&ring, big, 0xFF, (uint8_t)n);
    }
    TEST_ASSERT_EQUAL_UINT8(0, hal_ring_room(&ring, 0xFF));
    hal_ring_commit(&ring);
    for (unsigned n = 0; n < 255; n++) {
        TEST_ASSERT_EQUAL_UINT8(n, hal_ring_take(&ring, big, 0xFF));
    }
    TEST_ASSERT_TRUE(hal_ring_empty(&ring));
}
