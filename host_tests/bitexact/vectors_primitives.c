/* Paths of the primitives: every public function of fx.h that computes (bitexact.py compares the names). */
#include "fx.h"
#include "vectors.h"

enum { ITEMS = 2 * VECTORS_BLOCK };

static const uint32_t edges[] IN_FLASH = {
    0UL,      1UL,       2UL,        0x7FUL,     0x80UL,     0xFFUL,      0x100UL,      0x7FFFUL,     0x8000UL,
    0xFFFFUL, 0x10000UL, 0x7FFFFFUL, 0x800000UL, 0xFFFFFFUL, 0x1000000UL, 0x7FFFFFFFUL, 0x80000000UL, 0xFFFFFFFFUL,
};

enum { EDGES = sizeof edges / sizeof edges[0] };

static uint32_t pack(fx_scaled_t v)
{
    return ((uint32_t)v.mantissa << 8) | (uint8_t)v.exponent;
}

/* An exponent within -50..49. */
static fx_scaled_t scaled_of(uint32_t v)
{
    fx_scaled_t scaled = { (uint16_t)(v | 0x8000U), (int8_t)((int8_t)((v >> 16) % 100U) - 50) };
    return scaled;
}

/* The halves of any two numbers have a sum and a difference. */
#define HALF(v) ((int32_t)(v) / 2)

/* The number shifted, with the places in its low bits: both are the same in every build or the result is another. */
static uint32_t normalised(uint32_t v)
{
    uint8_t places = fx_normalise(&v);
    return v ^ places;
}

static uint32_t normalised_c(uint32_t v)
{
    uint8_t places = fx_normalise_c(&v);
    return v ^ places;
}

#define A16 ((uint16_t)a)
#define B16 ((uint16_t)b)
#define A24 (a & 0xFFFFFFUL)
#define B24 (b & 0xFFFFFFUL)
#define NOT_0(v) ((v) == 0U ? 1U : (v))
#define LED(v) ((v) | 0x80000000UL)
/* 0 or one of 2, 4 .. 128 */
#define PART(v) ((uint8_t)(2U << ((v)&7U)))
#define POSITIVE(v) ((int32_t)((v)&0x7FFFFFFFUL))

/* X(name, what it gives for the operands a and b) */
#define PRIMITIVES(X)                                                                \
    X(fx_product_u16, fx_product_u16(A16, B16))                                      \
    X(filter_fx_mul_uq16, filter_fx_mul_uq16(a, B16))                                \
    X(filter_fx_mul16_uq16, filter_fx_mul16_uq16(A16, B16))                          \
    X(filter_fx_mul24_uq16, filter_fx_mul24_uq16(A24, B16))                          \
    X(filter_fx_mul24_uq24, filter_fx_mul24_uq24(A24, B24))                          \
    X(filter_fx_mul_uq24, filter_fx_mul_uq24(a, B24))                                \
    X(fx_shift12, fx_shift12(A16))                                                   \
    X(fx_eightfold, fx_eightfold(a))                                                 \
    X(fx_sixteenth, fx_sixteenth(a))                                                 \
    X(fx_mul_uq16_c, fx_mul_uq16_c(a, B16))                                          \
    X(fx_mul16_uq16_c, fx_mul16_uq16_c(A16, B16))                                    \
    X(fx_mul24_uq16_c, fx_mul24_uq16_c(A24, B16))                                    \
    X(fx_mul24_uq24_c, fx_mul24_uq24_c(A24, B24))                                    \
    X(fx_mul_uq24_c, fx_mul_uq24_c(a, B24))                                          \
    X(fx_shift12_c, fx_shift12_c(A16))                                               \
    X(fx_eightfold_c, fx_eightfold_c(a))                                             \
    X(fx_sixteenth_c, fx_sixteenth_c(a))                                             \
    X(fx_normalise_c, normalised_c(NOT_0(a)))                                        \
    X(fx_normalise, normalised(NOT_0(a)))                                            \
    X(fx_shift_right_c, fx_shift_right_c(a, (uint8_t)(b & 31U)))                     \
    X(filter_fx_shift_right, filter_fx_shift_right(a, (uint8_t)(b & 31U)))           \
    X(fx_without_part_c, (uint32_t)fx_without_part_c(HALF(a), PART(b)))              \
    X(fx_without_part, (uint32_t)fx_without_part(HALF(a), PART(b)))                  \
    X(fx_clamp_high_c, (uint32_t)fx_clamp_high_c((int32_t)a, 54))                    \
    X(fx_clamp_high, (uint32_t)fx_clamp_high((int32_t)a, 54))                        \
    X(filter_fx_high_u16, filter_fx_high_u16(A16, B16))                              \
    X(filter_fx_leading, filter_fx_leading(a))                                       \
    X(fx_places, fx_places(a))                                                       \
    X(fx_mantissa, fx_mantissa(a))                                                   \
    X(filter_fx_inverse_uq16, filter_fx_inverse_uq16(LED(a)))                        \
    X(filter_fx_abs32, filter_fx_abs32((int32_t)a))                                  \
    X(fx_upper_c, fx_upper_c(&a))                                                    \
    X(fx_upper, fx_upper(&a))                                                        \
    X(fx_upper_signed_c, (uint32_t)fx_upper_signed_c((const int32_t *)&a))           \
    X(fx_upper_signed, (uint32_t)fx_upper_signed((const int32_t *)&a))               \
    X(fx_add_sat, fx_add_sat(a, b))                                                  \
    X(fx_clamp, (uint32_t)fx_clamp((int32_t)a, POSITIVE(b)))                         \
    X(fx_inverse_m_uq16, fx_inverse_m_uq16((uint8_t)(a & 0x7FU), B16))               \
    X(fx_reciprocal_uq16, fx_reciprocal_uq16(a < 0x1000000UL ? a | 0x1000000UL : a)) \
    X(filter_fx_isqrt32, filter_fx_isqrt32(a))                                       \
    X(filter_fx_scaled, pack(filter_fx_scaled(a)))                                   \
    X(filter_fx_scaled_mul, pack(filter_fx_scaled_mul(scaled_of(a), scaled_of(b))))  \
    X(filter_fx_scaled_div, pack(filter_fx_scaled_div(scaled_of(a), scaled_of(b))))  \
    X(filter_fx_scaled_fixed, filter_fx_scaled_fixed(scaled_of(a), (uint8_t)(b & 31U)))

enum {
#define NUMBER(name, result) NUMBER_##name,
    PRIMITIVES(NUMBER)
#undef NUMBER
        PRIMITIVE_COUNT
};

static const char names[PRIMITIVE_COUNT][27] IN_FLASH = {
#define NAME(name, result) #name,
    PRIMITIVES(NAME)
#undef NAME
};

uint8_t primitive_paths(void)
{
    return PRIMITIVE_COUNT;
}

vectors_path_t primitive_path(uint8_t which)
{
    return (vectors_path_t){ names[which], ITEMS };
}

static uint32_t result_of(uint8_t which, uint32_t a, uint32_t b)
{
    switch (which) {
#define RESULT(name, result) \
    case NUMBER_##name:      \
        return result;
        PRIMITIVES(RESULT)
#undef RESULT
    default:
        return 0;
    }
}

/* Edges against random operands first, then random ones of all magnitudes. */
static uint32_t operand(uint16_t index)
{
    uint32_t v = vectors_random();
    return (index < VECTORS_BLOCK && (v & 1U) != 0U) ? flash_u32(&edges[(v >> 8) % EDGES]) : v >> (v & 31U);
}

void primitive_path_item(uint8_t which, uint16_t index)
{
    uint32_t a = operand(index);
    uint32_t b = operand(index);
    vectors_input(a);
    vectors_input(b);
    vectors_output(result_of(which, a, b), 4);
}
