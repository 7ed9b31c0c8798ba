/*
 * Runs on the ATmega328P (simavr): each assembler primitive of fx.h against its C twin, edges crossed with edges, then
 * random operands. One line per primitive on the UART (115200 8N1), "PASS name" or "FAIL name a b"; then sleeps with
 * interrupts off.
 */
#include "fx.h"
#include "fx_dot.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/pgmspace.h>
#include <avr/sleep.h>

#define RANDOM_PAIRS 4000U

static const uint32_t edges[] PROGMEM = {
    0UL,        1UL,         2UL,          0x7FUL,       0x80UL,       0xFFUL,       0x100UL,
    0x7FFFUL,   0x8000UL,    0xFFFFUL,     0x10000UL,    0x7FFFFFUL,   0x800000UL,   0xFF00FFUL,
    0xFFFFFFUL, 0x1000000UL, 0x7FFFFFFFUL, 0x80000000UL, 0xFFFF0000UL, 0xFFFFFFFFUL,
};

enum { EDGES = sizeof edges / sizeof edges[0] };

static void put(char c)
{
    while ((UCSR0A & _BV(UDRE0)) == 0) {
    }
    UDR0 = (uint8_t)c;
}

static void put_text(const char *flash_text)
{
    for (char c; (c = (char)pgm_read_byte(flash_text)) != '\0'; flash_text++) {
        put(c);
    }
}

static void put_hex(uint32_t v)
{
    put(' ');
    for (uint8_t i = 0; i < 8; i++, v <<= 4) {
        uint8_t digit = (uint8_t)(v >> 28);
        put((char)(digit < 10 ? '0' + digit : 'a' + digit - 10));
    }
}

static uint32_t random_state = 2463534242UL;

/* xorshift32 (Marsaglia), thinned to all magnitudes. */
static uint32_t random_operand(void)
{
    random_state ^= random_state << 13;
    random_state ^= random_state >> 17;
    random_state ^= random_state << 5;
    return random_state >> (random_state & 15);
}

#define TWIN(name, assembler, c_twin)               \
    static bool twin_##name(uint32_t a, uint32_t b) \
    {                                               \
        (void)b;                                    \
        return (assembler) == (c_twin);             \
    }

/* 0, 2, 4 .. 128 */
#define PART(b) ((uint8_t)((1U << ((b)&7U)) & 0xFEU))

TWIN(mul16_uq16, filter_fx_mul16_uq16((uint16_t)a, (uint16_t)b), fx_mul16_uq16_c((uint16_t)a, (uint16_t)b))
TWIN(mul_uq16, filter_fx_mul_uq16(a, (uint16_t)b), fx_mul_uq16_c(a, (uint16_t)b))
TWIN(mul_uq24, filter_fx_mul_uq24(a, b & 0xFFFFFFUL), fx_mul_uq24_c(a, b & 0xFFFFFFUL))
TWIN(mul24_uq16, filter_fx_mul24_uq16(a & 0xFFFFFFUL, (uint16_t)b), fx_mul24_uq16_c(a & 0xFFFFFFUL, (uint16_t)b))
TWIN(mul24_uq24, filter_fx_mul24_uq24(a & 0xFFFFFFUL, b & 0xFFFFFFUL), fx_mul24_uq24_c(a & 0xFFFFFFUL, b & 0xFFFFFFUL))
TWIN(sixteenth, fx_sixteenth(a), fx_sixteenth_c(a))
TWIN(shift12, fx_shift12((uint16_t)a), fx_shift12_c((uint16_t)a))
TWIN(eightfold, fx_eightfold(a), fx_eightfold_c(a))
TWIN(without_part, fx_without_part((int32_t)a, PART(b)), fx_without_part_c((int32_t)a, PART(b)))
TWIN(clamp_high, fx_clamp_high((int32_t)a, 54), fx_clamp_high_c((int32_t)a, 54))
TWIN(shift_right, filter_fx_shift_right(a, (uint8_t)b & 31U), fx_shift_right_c(a, (uint8_t)b & 31U))

TWIN(upper, fx_upper(&a), fx_upper_c(&a))
TWIN(upper_signed, fx_upper_signed((const int32_t *)&a), fx_upper_signed_c((const int32_t *)&a))

static bool twin_normalise(uint32_t a, uint32_t b)
{
    uint32_t by_assembler = (a >> ((uint8_t)b & 31U)) | 1U; /* not 0: it has no leading bit */
    uint32_t by_c = by_assembler;
    return fx_normalise(&by_assembler) == fx_normalise_c(&by_c) && by_assembler == by_c;
}

/* Either operand's bytes in every place of the row and of the column. */
static bool twin_dot24(uint32_t a, uint32_t b)
{
    const int32_t row[3] = { (int32_t)a, (int32_t)b, (int32_t)(a >> 8) };
    const int16_t column[3] = { (int16_t)b, (int16_t)(a >> 16), (int16_t)(b >> 8) };
    return fx_dot24((int32_t)b, row, column) == fx_dot24_c((int32_t)b, row, column);
}

static bool run(bool (*twin)(uint32_t, uint32_t), const char *flash_name)
{
    uint32_t a = 0;
    uint32_t b = 0;
    bool same = true;
    for (uint16_t i = 0; same && i < EDGES * EDGES; i++) {
        a = pgm_read_dword(&edges[i / EDGES]);
        b = pgm_read_dword(&edges[i % EDGES]);
        same = twin(a, b);
    }
    for (uint16_t i = 0; same && i < RANDOM_PAIRS; i++) {
        a = random_operand();
        b = random_operand();
        same = twin(a, b);
    }
    put_text(same ? PSTR("PASS ") : PSTR("FAIL "));
    put_text(flash_name);
    if (!same) {
        put_hex(a);
        put_hex(b);
    }
    put('\n');
    return same;
}

#define RUN(name) run(twin_##name, PSTR(#name))

int main(void)
{
    UCSR0A = _BV(U2X0);
    UBRR0 = 16;
    UCSR0B = _BV(TXEN0);
    RUN(mul16_uq16);
    RUN(mul_uq16);
    RUN(mul_uq24);
    RUN(mul24_uq16);
    RUN(mul24_uq24);
    RUN(sixteenth);
    RUN(shift12);
    RUN(eightfold);
    RUN(without_part);
    RUN(clamp_high);
    RUN(shift_right);
    RUN(upper);
    RUN(upper_signed);
    RUN(normalise);
    RUN(dot24);
    while ((UCSR0A & _BV(UDRE0)) == 0) {
    }
    cli();
    sleep_enable();
    sleep_cpu();
    for (;;) {
    }
}
