/* The primitives, in their C twins: any argument. */
#include "eva.h"
#include "fx_contracts.h"

#include "fx.c"

static void reciprocal_in(uint32_t from, uint32_t to)
{
    (void)fx_reciprocal_uq16(ANY_U32(from, to));
}

/*
 * One call for each interval of the table and each number of halvings: together all of 1 <= s < 256. Whole:
 * fx_inverse_m_uq16
 */
void proof_fx_reciprocal_uq16(void)
{
    uint32_t from = 0x1000000U;
    bool whole = false;
    for (uint8_t halvings = 0; halvings < 8; halvings++) {
        uint32_t width = (uint32_t)0x20000U << halvings;
        for (uint8_t node = 0; node < 128; node++) {
            uint32_t to = from + (width - 1U);
            reciprocal_in(from, to);
            if (to != UINT32_MAX) {
                from = to + 1U;
            } else {
                whole = halvings == 7 && node == 127;
            }
        }
    }
    //@ check whole_range: whole == 1;
}

void proof_fx_inverse_m_uq16(void)
{
    for (uint8_t interval = 0; interval < 128; interval++) {
        (void)fx_inverse_m_uq16(interval, ANY_U16(0, UINT16_MAX));
    }
}

/* One call for each position of the leading bit. */
void proof_fx_normalise(void)
{
    for (uint8_t bit = 0; bit < 32; bit++) {
        uint32_t from = (uint32_t)1U << bit;
        uint32_t v = ANY_U32(from, from + (from - 1U));
        (void)fx_normalise(&v);
    }
}

/* One call for each exponent; a mantissa of ones, which rounding up carries, apart. */
void proof_rounded(void)
{
    for (int8_t exponent = -110; exponent <= 60; exponent++) {
        (void)rounded(ANY_U32(0x80000000U, 0xFFFEFFFFU), exponent);
        (void)rounded(ANY_U32(0xFFFF0000U, UINT32_MAX), exponent);
    }
}

/* Options: -eva-slevel 1 -eva-min-loop-unroll 16 */
void proof_filter_fx_isqrt32(void)
{
    (void)filter_fx_isqrt32(ANY_U32(0, 12287));
    (void)filter_fx_isqrt32(ANY_U32(12288, 12543)); /* 112^2 less 1 */
    (void)filter_fx_isqrt32(ANY_U32(12544, 16383));
    //@ loop unroll 8;
    for (uint32_t from = 16384; from < 0x1000000U; from *= 4U) {
        (void)filter_fx_isqrt32(ANY_U32(from, 4U * from - 1U));
    }
    (void)filter_fx_isqrt32(ANY_U32(0x1000000U, 0x2000000U));
    (void)filter_fx_isqrt32(ANY_U32(0x2000001U, 0x3FFFFFFU));
    (void)filter_fx_isqrt32(ANY_U32(0x4000000U, SQUARE(27UL) - 1U));
    //@ loop unroll 5;
    for (uint32_t k = 27; k < 32U; k++) {
        (void)filter_fx_isqrt32(ANY_U32(SQUARE(k), SQUARE(k + 1U) - 1U));
    }
    (void)filter_fx_isqrt32(0x10000000U);
    (void)filter_fx_isqrt32(ANY_U32(0x10000001U, 0x3FFFFFFFU));
    (void)filter_fx_isqrt32(0x40000000U);
    (void)filter_fx_isqrt32(ANY_U32(0x40000001U, UINT32_MAX));
}

static fx_scaled_t any_scaled(void)
{
    fx_scaled_t v = { ANY_U16(0x8000, UINT16_MAX), ANY_S8(-28, 14) };
    return v;
}

void proof_filter_fx_scaled(void)
{
    (void)filter_fx_scaled(ANY_U32(0, UINT32_MAX));
    (void)filter_fx_scaled_mul(any_scaled(), any_scaled());
    (void)filter_fx_scaled_div(any_scaled(), any_scaled());
    fx_scaled_t v = { ANY_U16(0, UINT16_MAX), ANY_S8(-128, 127) };
    (void)filter_fx_scaled_fixed(v, ANY_U8(0, 28));
}

/* The results at the largest arguments: a product that lost bits is no longer the largest. */
void proof_fx_products(void)
{
    uint32_t any = ANY_U32(0, UINT32_MAX);
    uint16_t half = ANY_U16(0, UINT16_MAX);
    uint32_t low24 = ANY_U32(0, 0xFFFFFF);
    uint32_t exact = fx_product_u16(half, ANY_U16(0, UINT16_MAX));
    //@ check exact <= 65535 * 65535;
    (void)filter_fx_mul_uq16(any, half);
    (void)filter_fx_mul16_uq16(half, ANY_U16(0, UINT16_MAX));
    (void)filter_fx_mul24_uq16(low24, half);
    (void)filter_fx_mul24_uq24(low24, ANY_U32(0, 0xFFFFFF));
    (void)filter_fx_mul_uq24(any, low24);
    (void)fx_shift12(half);
    (void)fx_eightfold(any);
    (void)fx_sixteenth(any);
}

static void without_part_between(int32_t from, int32_t to, uint8_t part_uq8)
{
    (void)fx_without_part(ANY_S32(from, to), part_uq8);
    (void)fx_without_part(ANY_S32(-to, -from), part_uq8);
}

/* One call for each part that is taken, each sign and each position of the leading bit, 18432 LSB apart. */
void proof_fx_without_part(void)
{
    for (uint8_t k = 0; k < 8; k++) {
        uint8_t part_uq8 = (uint8_t)(0x80U >> k);
        for (uint8_t bit = 0; bit < 30; bit++) {
            int32_t from = (int32_t)((uint32_t)1U << bit);
            without_part_between(from, from + (from - 1), part_uq8);
        }
        without_part_between(0x40000000, 18432L * 65536, part_uq8);
        without_part_between(18432L * 65536 + 1, INT32_MAX, part_uq8);
        without_part_between(0, 0, part_uq8);
        (void)fx_without_part(S32_MIN, part_uq8);
    }
    int32_t whole = fx_without_part(INT32_MAX, 0);
    int32_t least = fx_without_part(S32_MIN, 0);
    //@ check nothing_taken: whole == 2147483647 && least == -2147483648;
}

/* Below, within and above each limit. */
void proof_fx_clamp_high(void)
{
    for (uint8_t limit = 1; limit < 128; limit++) {
        int32_t end = (int32_t)limit * 16777216;
        (void)fx_clamp_high(ANY_S32(S32_MIN, -end - 1), limit);
        (void)fx_clamp_high(ANY_S32(-end, -1), limit);
        (void)fx_clamp_high(0, limit);
        (void)fx_clamp_high(ANY_S32(1, end), limit);
        (void)fx_clamp_high(ANY_S32(end + 1, INT32_MAX), limit);
        int32_t least = fx_clamp_high(-end, limit);
        int32_t most = fx_clamp_high(end - 1, limit);
        //@ check kept: least == -end && most == end - 1;
    }
}

void proof_fx_rest(void)
{
    uint32_t size = filter_fx_abs32(ANY_S32(S32_MIN, INT32_MAX));
    //@ check size <= 0x80000000;
    uint32_t sum = fx_add_sat(ANY_U32(0, UINT32_MAX), ANY_U32(0, UINT32_MAX));
    int32_t limited = fx_clamp(ANY_S32(S32_MIN, INT32_MAX), ANY_S32(0, 1000));
    //@ check -1000 <= limited <= 1000;
    static const uint32_t word IN_FLASH = 7;
    static const void *const pointer IN_FLASH = &word;
    (void)flash_u8((const uint8_t *)&word);
    (void)flash_u32(&word);
    (void)flash_pointer(&pointer);
}
