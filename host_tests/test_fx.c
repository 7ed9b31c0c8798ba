/* Fixed-point primitives: C twins against exact integer arithmetic, the reciprocal against 1/s. */
#include "fx.h"
#include "support_filters.h"
#include "unity.h"

#include <math.h>

#define SEED 2718

void setUp(void) {}

void tearDown(void) {}

/* Values where carries and roundings change, and random ones between. */
static uint32_t operand(test_random_t *random, int i)
{
    static const uint32_t edges[] = { 0,        1,        2,         0x7F,       0x80,        0xFF,
                                      0x100,    0x7FFF,   0x8000,    0xFFFF,     0x10000,     0x7FFFFF,
                                      0x800000, 0xFFFFFF, 0x1000000, 0x7FFFFFFF, 0x80000000U, 0xFFFFFFFFU };
    return i < 18 ? edges[i] : random_u32(random) >> (i % 25);
}

static uint64_t half_up(uint64_t v, int shift)
{
    return (v >> shift) + ((v >> (shift - 1)) & 1U);
}

static void products_equal_exact_arithmetic(void)
{
    test_random_t random;
    random_seed(&random, SEED);
    for (int i = 0; i < 600; i++) {
        for (int j = 0; j < 600; j++) {
            uint32_t a = operand(&random, i);
            uint32_t b = operand(&random, j);
            uint32_t b24 = b & 0xFFFFFFU;
            uint32_t a24 = a & 0xFFFFFFU;
            uint16_t b16 = (uint16_t)b;
            TEST_ASSERT_EQUAL_UINT64((uint64_t)(uint16_t)a * b16, fx_mul_u16((uint16_t)a, b16));
            TEST_ASSERT_EQUAL_UINT64(half_up((uint64_t)(uint16_t)a * b16, 16), fx_mul16_uq16((uint16_t)a, b16));
            TEST_ASSERT_EQUAL_UINT64(half_up((uint64_t)a * b16, 16), fx_mul_uq16(a, b16));
            TEST_ASSERT_EQUAL_UINT64(half_up((uint64_t)a * b24, 24), fx_mul_uq24(a, b24));
            TEST_ASSERT_EQUAL_UINT64(half_up((uint64_t)a24 * b16, 8), fx_mul24_uq16(a24, b16));
            TEST_ASSERT_EQUAL_UINT64(half_up((uint64_t)a24 * b24, 16), fx_mul24_uq24(a24, b24));
        }
    }
}

static void shifts_equal_exact_arithmetic(void)
{
    test_random_t random;
    random_seed(&random, SEED + 1);
    for (int i = 0; i < 20000; i++) {
        uint32_t v = operand(&random, i);
        TEST_ASSERT_EQUAL_UINT64(half_up(v, 4), fx_sixteenth(v));
        TEST_ASSERT_EQUAL_UINT32((uint16_t)v * 4096U, fx_shift12((uint16_t)v));
        TEST_ASSERT_EQUAL_UINT32(v * 8U, fx_eightfold(v));
    }
}

/*
 * Every node and every 2^-16 step of 1 <= s < 16: chord 0.25 + nodes 0.5 + product 0.5 (+ 0.25 of the first node's
 * limit); each halving halves the error and adds at most 0.5 by rounding. */
static void reciprocal_is_within_its_bound(void)
{
    for (uint32_t s = 0x10000000U; s >= 0x10000000U; s += 0x1001U) {
        double exact = 65536.0 * 268435456.0 / (double)s;
        TEST_ASSERT_DOUBLE_WITHIN(1.5, fmin(exact, 65535.0), (double)fx_reciprocal_uq16(s));
    }
    TEST_ASSERT_EQUAL_UINT16(65535, fx_reciprocal_uq16(0x10000000U));
    TEST_ASSERT_EQUAL_UINT16(32768, fx_reciprocal_uq16(0x20000000U));
    TEST_ASSERT_EQUAL_UINT16(16384, fx_reciprocal_uq16(0x40000000U));
}

static void saturating_and_clamping(void)
{
    TEST_ASSERT_EQUAL_UINT32(0x80000000U, fx_abs32(INT32_MIN));
    TEST_ASSERT_EQUAL_UINT32(7, fx_abs32(-7));
    TEST_ASSERT_EQUAL_INT32(-5, fx_clamp(-9, 5));
    TEST_ASSERT_EQUAL_INT32(5, fx_clamp(9, 5));
    TEST_ASSERT_EQUAL_INT32(-4, fx_clamp(-4, 5));
}

static void square_root_is_the_floor(void)
{
    for (uint32_t root = 0; root < 65536U; root++) {
        uint32_t square = root * root;
        TEST_ASSERT_EQUAL_UINT16(root, fx_isqrt32(square));
        if (root > 0U) {
            TEST_ASSERT_EQUAL_UINT16(root - 1U, fx_isqrt32(square - 1U));
        }
    }
    TEST_ASSERT_EQUAL_UINT16(65535, fx_isqrt32(UINT32_MAX));
}

static double scaled_value(fx_scaled_t v)
{
    return ldexp(v.mantissa, v.exponent);
}

static void scaled_numbers_keep_fourteen_bits(void)
{
    test_random_t random;
    random_seed(&random, SEED + 2);
    for (int i = 0; i < 50000; i++) {
        uint32_t a = (random_u32(&random) >> random_below(&random, 31)) + 1U;
        uint32_t b = (random_u32(&random) >> random_below(&random, 31)) + 1U;
        fx_scaled_t fa = fx_scaled(a == 0U ? 1U : a);
        fx_scaled_t fb = fx_scaled(b == 0U ? 1U : b);
        double da = scaled_value(fa);
        double db = scaled_value(fb);
        TEST_ASSERT_TRUE(fabs(da / (a == 0U ? 1.0 : a) - 1.0) <= ldexp(1.0, -16));
        TEST_ASSERT_TRUE(fabs(scaled_value(fx_scaled_mul(fa, fb)) / (da * db) - 1.0) <= ldexp(1.0, -14));
        TEST_ASSERT_TRUE(fabs(scaled_value(fx_scaled_div(fa, fb)) / (da / db) - 1.0) <= ldexp(1.0, -14));
    }
}

/* The multiples of 1/16: 2.5 = 0xA000 x 2^-14. */
static void scaled_to_fixed_rounds_and_saturates(void)
{
    fx_scaled_t two_and_a_half = { 0xA000U, -14 };
    TEST_ASSERT_EQUAL_UINT32(40, fx_scaled_fixed(two_and_a_half, 4));
    TEST_ASSERT_EQUAL_UINT32(3, fx_scaled_fixed(two_and_a_half, 0));
    fx_scaled_t huge = { 0x8000U, 20 };
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, fx_scaled_fixed(huge, 0));
    fx_scaled_t tiny = { 0xFFFFU, -60 };
    TEST_ASSERT_EQUAL_UINT32(0, fx_scaled_fixed(tiny, 28));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(products_equal_exact_arithmetic);
    RUN_TEST(shifts_equal_exact_arithmetic);
    RUN_TEST(reciprocal_is_within_its_bound);
    RUN_TEST(saturating_and_clamping);
    RUN_TEST(square_root_is_the_floor);
    RUN_TEST(scaled_numbers_keep_fourteen_bits);
    RUN_TEST(scaled_to_fixed_rounds_and_saturates);
    return UNITY_END();
}
