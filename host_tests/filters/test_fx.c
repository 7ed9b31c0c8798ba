/* Fixed-point primitives against exact integer arithmetic; on the chip these are the ones in assembler. */
#include "fx.h"
#include "support/filters.h"
#include "support/test.h"

#define SEED 2718UL

static uint32_t random_state;

void setUp(void)
{
    random_state = SEED;
}

/* Values where carries and roundings change, and random ones of all magnitudes between. */
static uint32_t operand(uint16_t i)
{
    static const uint32_t edges[] = { 0,        1,        2,         0x7F,       0x80,        0xFF,
                                      0x100,    0x7FFF,   0x8000,    0xFFFF,     0x10000,     0x7FFFFF,
                                      0x800000, 0xFFFFFF, 0x1000000, 0x7FFFFFFF, 0x80000000U, 0xFFFFFFFFU };
    return (i < 18U) ? edges[i] : random32(&random_state) >> (i % 25U);
}

/* The product / 2^shift rounded half up; all results fit 32 bits. */
static uint32_t half_up(uint64_t v, uint8_t shift)
{
    return (uint32_t)((v + ((uint64_t)1 << (shift - 1))) >> shift);
}

TEST(products_equal_exact_arithmetic)
{
    for (uint16_t i = 0; i < ON_PC_OR_CHIP(600, 60); i++) {
        for (uint16_t j = 0; j < ON_PC_OR_CHIP(600, 60); j++) {
            uint32_t a = operand(i);
            uint32_t b = operand(j);
            uint32_t b24 = b & 0xFFFFFFU;
            uint32_t a24 = a & 0xFFFFFFU;
            uint16_t a16 = (uint16_t)a;
            uint16_t b16 = (uint16_t)b;
            TEST_ASSERT_EQUAL_HEX32((uint32_t)((uint64_t)a16 * b16), fx_product_u16(a16, b16));
            TEST_ASSERT_EQUAL_HEX32(half_up((uint64_t)a16 * b16, 16), filter_fx_mul16_uq16(a16, b16));
            TEST_ASSERT_EQUAL_HEX32(half_up((uint64_t)a * b16, 16), filter_fx_mul_uq16(a, b16));
            TEST_ASSERT_EQUAL_HEX32(half_up((uint64_t)a * b24, 24), filter_fx_mul_uq24(a, b24));
            TEST_ASSERT_EQUAL_HEX32(half_up((uint64_t)a24 * b16, 8), filter_fx_mul24_uq16(a24, b16));
            TEST_ASSERT_EQUAL_HEX32(half_up((uint64_t)a24 * b24, 16), filter_fx_mul24_uq24(a24, b24));
        }
    }
}

TEST(shifts_equal_exact_arithmetic)
{
    for (uint16_t i = 0; i < ON_PC_OR_CHIP(20000, 1000); i++) {
        uint32_t v = operand(i);
        TEST_ASSERT_EQUAL_HEX32(half_up(v, 4), fx_sixteenth(v));
        TEST_ASSERT_EQUAL_HEX32((v & 0xFFFFU) * 4096U, fx_shift12((uint16_t)v));
        TEST_ASSERT_EQUAL_HEX32(v * 8U, fx_eightfold(v));
    }
}

/* v - v / 2^k with what is taken rounded half up, and v with nothing taken. */
TEST(without_a_part_equals_exact_arithmetic)
{
    for (uint16_t i = 0; i < ON_PC_OR_CHIP(20000, 1000); i++) {
        int64_t v = (int32_t)operand(i);
        TEST_ASSERT_EQUAL_INT32((int32_t)v, fx_without_part((int32_t)v, 0));
        for (uint8_t k = 1; k < 8; k++) {
            int64_t above = v + ((int64_t)1 << (k - 1)) + ((int64_t)1 << 40); /* not negative: rounded down */
            int64_t part = (above >> k) - ((int64_t)1 << (40 - k));
            TEST_ASSERT_EQUAL_INT32((int32_t)(v - part), fx_without_part((int32_t)v, (uint8_t)(256U >> k)));
        }
        int64_t limit = (int64_t)72 << 24;
        int64_t limited = (v > limit) ? limit : v;
        limited = (limited < -limit) ? -limit : limited;
        TEST_ASSERT_EQUAL_INT32((int32_t)limited, fx_clamp_high((int32_t)v, 72));
    }
}

/* The leading bit at the top, the places it moved by, and what is left of the number: all of it above the low byte. */
TEST(leading_bits_by_definition)
{
    for (uint16_t i = 0; i < ON_PC_OR_CHIP(20000, 1000); i++) {
        uint32_t v = operand(i) | 1U;
        fx_leading_t leading = filter_fx_leading(v);
        uint8_t places = fx_places(leading);
        TEST_ASSERT_TRUE(places < 32U && (leading & 0x80000000U) != 0U);
        TEST_ASSERT_EQUAL_HEX32((v << places) & 0xFFFFFF00U, leading & 0xFFFFFF00U);
        TEST_ASSERT_EQUAL_HEX32(v, (v << places) >> places);
        TEST_ASSERT_EQUAL_HEX16((uint16_t)((v << places) >> 16), fx_mantissa(leading));
        TEST_ASSERT_EQUAL_HEX32(v >> places, filter_fx_shift_right(v, places));
    }
    TEST_ASSERT_EQUAL_HEX32(filter_fx_leading(1), filter_fx_leading(0));
}

/* Rounded down, as no other product is. */
TEST(upper_half_equals_exact_arithmetic)
{
    for (uint16_t i = 0; i < ON_PC_OR_CHIP(20000, 1000); i++) {
        uint32_t a = operand(i);
        uint32_t b = operand((uint16_t)(i + 7U));
        TEST_ASSERT_EQUAL_HEX16((uint16_t)((uint64_t)(uint16_t)a * (uint16_t)b >> 16),
                                filter_fx_high_u16((uint16_t)a, (uint16_t)b));
    }
}

/* 1 <= m < 2: chord 0.25 + nodes 0.5 + product 0.5 + 0.25 of the first node limited. |r - 2^47 / m| <= 1.5: exact. */
TEST(reciprocal_of_leading_bits_is_within_its_bound)
{
    const uint32_t step = ON_PC_OR_CHIP(0x1001U, 0x200000U + 0x1001U);
    for (uint32_t m = 0x80000000U; m >= 0x80000000U; m += step) {
        int64_t twice_error = ((int64_t)((uint64_t)filter_fx_inverse_uq16(m) * m) - ((int64_t)1 << 47)) * 2;
        TEST_ASSERT_TRUE((twice_error < 0 ? -twice_error : twice_error) <= (int64_t)3 * m);
    }
}

/*
 * Steps through all of 1 <= s < 256: chord 0.25 + nodes 0.5 + product 0.5 (+ 0.25 of the first node's limit); each
 * halving halves the error and adds at most 0.5 by rounding. |r - 2^40 / s| <= 1.5 multiplied by 2 s: exact.
 */
TEST(reciprocal_is_within_its_bound)
{
    const uint32_t step = ON_PC_OR_CHIP(0x1001U, 0x100000U + 0x1001U);
    for (uint32_t s = 0x1000000U; s >= 0x1000000U; s += step) {
        int64_t twice_error = (int64_t)((uint64_t)fx_reciprocal_uq16(s) * s * 2U) - ((int64_t)1 << 41);
        TEST_ASSERT_TRUE((twice_error < 0 ? -twice_error : twice_error) <= (int64_t)3 * s);
    }
    TEST_ASSERT_EQUAL_UINT16(65535, fx_reciprocal_uq16(0x1000000U));
    TEST_ASSERT_EQUAL_UINT16(32768, fx_reciprocal_uq16(0x2000000U));
    TEST_ASSERT_EQUAL_UINT16(512, fx_reciprocal_uq16(0x80000000U));
}

TEST(saturating_and_clamping)
{
    TEST_ASSERT_EQUAL_HEX32(0x80000000U, filter_fx_abs32(INT32_MIN));
    TEST_ASSERT_EQUAL_UINT32(7, filter_fx_abs32(-7));
    TEST_ASSERT_EQUAL_INT32(-5, fx_clamp(-9, 5));
    TEST_ASSERT_EQUAL_INT32(5, fx_clamp(9, 5));
    TEST_ASSERT_EQUAL_INT32(-4, fx_clamp(-4, 5));
    TEST_ASSERT_EQUAL_HEX32(UINT32_MAX, fx_add_sat(UINT32_MAX - 2U, 3U));
    TEST_ASSERT_EQUAL_HEX32(UINT32_MAX - 1U, fx_add_sat(UINT32_MAX - 2U, 1U));
}

TEST(square_root_is_the_floor)
{
    for (uint32_t root = 0; root < 65536U; root += ON_PC_OR_CHIP(1U, 17U)) {
        uint32_t square = root * root;
        TEST_ASSERT_EQUAL_UINT16(root, filter_fx_isqrt32(square));
        TEST_ASSERT_EQUAL_UINT16(root, filter_fx_isqrt32(square + 2U * root)); /* the last before the next square */
    }
    TEST_ASSERT_EQUAL_UINT16(65535, filter_fx_isqrt32(UINT32_MAX));
}

/* |a x 2^shift - b| 2^bits <= b: equal within 2^-bits; both below 2^48. */
static void assert_equal_to_bits(uint64_t a, int8_t shift, uint64_t b, uint8_t bits)
{
    if (shift >= 0) {
        a <<= (uint8_t)shift;
    } else {
        b <<= (uint8_t)-shift;
    }
    uint64_t difference = (a > b) ? a - b : b - a;
    TEST_ASSERT_TRUE(difference << bits <= b);
}

TEST(scaled_numbers_keep_fourteen_bits)
{
    for (uint16_t i = 0; i < ON_PC_OR_CHIP(50000, 500); i++) {
        uint32_t a = (random32(&random_state) >> random32_below(&random_state, 31)) + 1U;
        uint32_t b = (random32(&random_state) >> random32_below(&random_state, 31)) + 1U;
        fx_scaled_t fa = filter_fx_scaled(a);
        fx_scaled_t fb = filter_fx_scaled(b);
        assert_equal_to_bits(fa.mantissa, fa.exponent, (a == 0U) ? 1U : a, 16);
        fx_scaled_t product = filter_fx_scaled_mul(fa, fb);
        assert_equal_to_bits(product.mantissa, (int8_t)(product.exponent - fa.exponent - fb.exponent),
                             (uint64_t)fa.mantissa * fb.mantissa, 14);
        fx_scaled_t ratio = filter_fx_scaled_div(fa, fb);
        assert_equal_to_bits((uint64_t)ratio.mantissa * fb.mantissa,
                             (int8_t)(ratio.exponent - fa.exponent + fb.exponent), fa.mantissa, 14);
    }
}

/* The multiples of 1/16: 2.5 = 0xA000 x 2^-14. */
TEST(scaled_to_fixed_rounds_and_saturates)
{
    fx_scaled_t two_and_a_half = { 0xA000U, -14 };
    TEST_ASSERT_EQUAL_UINT32(40, filter_fx_scaled_fixed(two_and_a_half, 4));
    TEST_ASSERT_EQUAL_UINT32(3, filter_fx_scaled_fixed(two_and_a_half, 0));
    fx_scaled_t huge = { 0x8000U, 20 };
    TEST_ASSERT_EQUAL_HEX32(UINT32_MAX, filter_fx_scaled_fixed(huge, 0));
    fx_scaled_t tiny = { 0xFFFFU, -60 };
    TEST_ASSERT_EQUAL_UINT32(0, filter_fx_scaled_fixed(tiny, 28));
}
