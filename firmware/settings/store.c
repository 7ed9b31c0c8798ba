/*
 * The check is a cyclic code over bytes, elements of GF(256), instead of over bits: the two bytes of the remainder
 * modulo (x - 1)(x - 2) = x^2 + 3x + 2. Two errors d and e, n bytes apart, go undetected if d 2^n + e = 0 and d + e =
 * 0, so if 2^n = 1: the smallest such n is 255, and a record has 125 bytes at most. A bitwise CRC of the same size,
 * such as the usual CRC-16, misses one in 65,536 of such pairs, and takes more instructions.
 */
#include "settings/store.h"

#include "hal_eeprom.h"
#include "machine.h"

/* Offsets in a record and in its copies, after the image. */
enum { VERSION = STORE_IMAGE_SIZE, SEQUENCE, CHECK_HIGH, CHECK_LOW, MARK, END };

enum { COPY_0 = STORE_COPY_0 >> 8, COPY_1 = STORE_COPY_1 >> 8, OTHER_COPY = COPY_0 ^ COPY_1 }; /* address >> 8 */

/* OPENING, CLOSING: a save is in progress. */
enum { IDLE, FAILED, OPENING, CLOSING };

/* x^8 + x^4 + x^3 + x^2 + 1 without its leading term: the powers of 2 are all 255 nonzero elements. */
#define FIELD_POLYNOMIAL 0x1Du

/*
 * Of two sequence numbers, the one up to 63 ahead is the later. They are below 128, so never 0xFF, and no two damaged
 * bytes make a copy look as if nothing had ever been saved there.
 */
#define SEQUENCE_MASK 0x7Fu
#define SEQUENCE_HALF 0x40u

static struct save {
    uint8_t state;
    uint8_t place; /* to compare or write next */
    uint8_t copy;  /* the valid one: a save goes to the other */
    bool tried;    /* this byte was written: it must read back right */
    uint8_t *record;
} save;

static uint16_t address_of(uint8_t copy, uint8_t place)
{
    return (uint16_t)((uint16_t)copy << 8 | place);
}

/* The remainder of the record's first bytes, 1 or more: of all before the check it is the check; with the check, 0. */
static uint16_t remainder_of(uint8_t count)
{
    const uint8_t *byte = save.record;
    uint8_t high = 0;
    uint8_t low = 0;
    do {
        uint8_t out = *byte++ ^ high;
        uint8_t doubled = (uint8_t)(out * 2u);
        if ((out & 0x80u) != 0) {
            doubled ^= FIELD_POLYNOMIAL;
        }
        high = low ^ doubled ^ out;
        low = doubled;
    } while (--count != 0);
    return (uint16_t)((uint16_t)high << 8 | low);
}

/* Reads a copy and judges it by itself: STORE_DAMAGED, STORE_EMPTY, STORE_OTHER_VERSION or STORE_GOOD. */
static store_status_t fetch(uint8_t copy)
{
    uint8_t *byte = save.record;
    uint8_t place = 0;
    do {
        *byte++ = hal_eeprom_read(address_of(copy, place));
    } while (++place != END);
    const uint8_t *tail = byte - STORE_TAIL_SIZE;
    MACHINE_POINTER(tail);
    if ((tail[0] & tail[SEQUENCE - VERSION] & tail[MARK - VERSION]) == 0xFFu) {
        return STORE_EMPTY;
    }
    if (tail[MARK - VERSION] != STORE_IMAGE_SIZE || remainder_of(MARK) != 0) {
        return STORE_DAMAGED;
    }
    return tail[0] == STORE_VERSION ? STORE_GOOD : STORE_OTHER_VERSION;
}

/* The status of the valid copy, given that of the other one. */
static store_status_t overall_status(store_status_t status, store_status_t other)
{
    if (other == STORE_DAMAGED && status == STORE_EMPTY) {
        return STORE_DAMAGED;
    }
    return other == STORE_DAMAGED && status == STORE_GOOD ? STORE_OTHER_COPY : status;
}

store_status_t store_load(uint8_t record[STORE_RECORD_SIZE])
{
    save.record = record;
    save.state = IDLE;
    while (!hal_eeprom_ready()) {
    }
    store_status_t other = fetch(COPY_0);
    uint8_t before = save.record[SEQUENCE];
    store_status_t status = fetch(COPY_1);
    save.copy = COPY_1;
    if (other > status || (other == status && ((uint8_t)(record[SEQUENCE] - before) & SEQUENCE_HALF) != 0)) {
        save.copy = COPY_0;
        other = status;
        status = fetch(COPY_0);
    }
    return overall_status(status, other);
}

/* A failed save's sequence number is used again: otherwise many failures would make the next save look older. */
bool store_save_begin(void)
{
    if (store_busy()) {
        return false;
    }
    uint8_t *tail = save.record + STORE_IMAGE_SIZE;
    MACHINE_POINTER(tail);
    tail[0] = STORE_VERSION;
    tail[SEQUENCE - VERSION] = (uint8_t)(tail[SEQUENCE - VERSION] + 1u - save.state) & SEQUENCE_MASK;
    uint16_t check = remainder_of(CHECK_HIGH);
    tail[CHECK_HIGH - VERSION] = (uint8_t)(check >> 8);
    tail[CHECK_LOW - VERSION] = (uint8_t)check;
    tail[MARK - VERSION] = STORE_OPEN;
    save.state = OPENING;
    save.place = MARK;
    save.tried = false;
    return true;
}

/* Writes a byte that is not right, once; if it still is not right, the save has failed. */
static bool end_save_or_write(struct save *s, uint16_t address, uint8_t byte)
{
    if (s->tried) {
        s->state = FAILED;
    } else {
        hal_eeprom_write_start(address, byte);
        s->tried = true;
    }
    return false;
}

bool store_pass(void)
{
    struct save *s = &save;
    MACHINE_POINTER(s);
    if (s->state <= FAILED || !hal_eeprom_ready()) {
        return false;
    }
    uint8_t place = s->place;
    uint8_t *byte = s->record + place;
    uint16_t address = address_of(s->copy ^ OTHER_COPY, place);
    if (hal_eeprom_read(address) != *byte) {
        return end_save_or_write(s, address, *byte);
    }
    s->tried = false;
    if (s->state == CLOSING) {
        s->state = IDLE;
        s->copy ^= OTHER_COPY;
        return false;
    }
    if (++place == END) {
        place = 0;
    } else if (place == MARK) {
        byte[1] = STORE_IMAGE_SIZE;
        s->state = remainder_of(MARK) == 0 ? CLOSING : FAILED;
    }
    s->place = place;
    return true;
}

bool store_busy(void)
{
    return save.state > FAILED;
}

bool store_failed(void)
{
    return save.state == FAILED;
}
