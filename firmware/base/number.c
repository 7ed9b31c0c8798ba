/* See number.h. */
#include "base/number.h"

#include "base/text.h"
#include "machine.h"

/* value / 2^bits, in one place: each shift written out would be a loop of its own. */
static MACHINE_APART uint32_t down(uint32_t value, uint8_t bits)
{
    return value >> bits;
}

/* A number as far as it has been read. */
typedef struct {
    uint32_t limit;   /* of the digits before another one is added, so that they can be shifted */
    uint32_t digits;  /* including those after the point */
    uint16_t divisor; /* 10 to the number of decimals once the point has been read; else 0 */
    bool whole;       /* may end here: after a digit */
} reading_t;

/* False: the character does not continue the number. */
static bool take(reading_t *n, char c, bool point)
{
    if (c == '.' && point && n->whole && n->divisor == 0) {
        n->divisor = 1;
        n->whole = false;
        return true;
    }
    if (c < '0' || c > '9' || n->divisor >= 10000u || n->digits > n->limit) {
        return false;
    }
    n->digits = n->digits * 10u + (uint8_t)(c - '0');
    n->divisor = (uint16_t)(n->divisor * 10u);
    n->whole = true;
    return true;
}

bool number_parse(const char **text, uint8_t fraction_bits, uint32_t *value)
{
    const char *at = *text;
    bool negative = *at == '-';
    if (negative) {
        at++;
    }
    reading_t n = { down((UINT32_MAX >> 1) / 10u, fraction_bits), 0, 0, false };
    while (take(&n, *at, fraction_bits != 0)) {
        at++;
    }
    uint32_t result = n.digits << fraction_bits;
    if (!n.whole || (result & 0x80000000u) != 0 || (*at != ' ' && *at != '\0')) {
        return false;
    }
    while (*at == ' ') {
        at++;
    }
    *text = at;
    if (n.divisor != 0) {
        result = (result + n.divisor / 2u) / n.divisor;
    }
    *value = negative ? 0u - result : result;
    return true;
}

void number_write(uint32_t value, uint8_t fraction_bits)
{
    if (value & 0x80000000u) {
        text_char('-');
        value = 0u - value;
    }
    uint32_t whole = down(value, fraction_bits);
    text_u32(whole);
    uint16_t rest = (uint16_t)down((value - (whole << fraction_bits)) * 10000u, fraction_bits);
    if (rest != 0) {
        text_char('.');
    }
    while (rest != 0) {
        text_char((char)('0' + (uint8_t)(rest / 1000u)));
        rest = (uint16_t)(rest % 1000u * 10u);
    }
}
