/*
 * vectors [PATH BLOCK]: a line per block of each path (name, first index, CRC-32 of its answers), or in detail the
 * items of one block: index, inputs, output and state as bytes in hex. On the chip a simulator that wants the detail
 * writes the numbers of path and block into detail_path and detail_block during the first milliseconds. With
 * VECTORS_FILTERS 1 or 0 the program has the linked filters alone or all but filters: a chip's flash cannot hold all.
 */
#include "crc32.h"
#include "fx.h"
#include "output.h"
#include "support/filters.h"
#include "vectors.h"

#ifdef __AVR__
#include <util/delay.h>
#else
#include <stdlib.h>
#endif

enum { NONE = 255, DETAIL_WAIT_MS = 3 };

/* Poked by name: not to be renamed by the optimiser. */
volatile uint8_t detail_path __attribute__((used)) = NONE;
volatile uint8_t detail_block __attribute__((used)) = NONE;

static uint32_t random_state;
static uint32_t crc;
static bool detail;

uint32_t vectors_random(void)
{
    return random32(&random_state);
}

void vectors_input(uint32_t value)
{
    if (detail) {
        output_char(' ');
        output_hex(value, 8);
    }
}

/* Outputs are printed as they come: an item gives its inputs first. */
static void print_bytes(char mark, const uint8_t *bytes, uint8_t size)
{
    output_char(' ');
    output_char(mark);
    for (uint8_t i = 0; i < size; i++) {
        output_hex(bytes[i], 2);
    }
}

void vectors_output(uint32_t value, uint8_t bytes)
{
    uint8_t little_endian[4];
    for (uint8_t i = 0; i < bytes; i++, value >>= 8) {
        little_endian[i] = (uint8_t)value;
        crc = crc32_u8(crc, little_endian[i]);
    }
    if (detail) {
        print_bytes('>', little_endian, bytes);
    }
}

void vectors_state(const void *bytes, uint8_t size)
{
    if (detail) {
        print_bytes('=', (const uint8_t *)bytes, size);
    }
}

typedef vectors_path_t path_getter_t(uint8_t which);
typedef void path_item_t(uint8_t which, uint16_t index);

static void print_block(const char *flash_name, uint16_t first)
{
    for (char c = (char)flash_u8((const uint8_t *)flash_name); c != '\0';
         c = (char)flash_u8((const uint8_t *)flash_name)) {
        output_char(c);
        flash_name++;
    }
    output_char(' ');
    output_u32(first);
    output_char(' ');
    output_hex(crc32_value(crc), 8);
    output_char('\n');
}

/* number: of the path among all. */
static void run_path(uint8_t number, vectors_path_t path, path_item_t *item, uint8_t which)
{
    random_state = 0x9E3779B9UL + number;
    for (uint16_t index = 0; index < path.items; index++) {
        if (index % VECTORS_BLOCK == 0U) {
            crc = CRC32_START;
        }
        detail = number == detail_path && index / VECTORS_BLOCK == detail_block;
        if (detail) {
            output_u32(index);
        }
        item(which, index);
        if (detail) {
            output_char('\n');
        }
        if (index % VECTORS_BLOCK == VECTORS_BLOCK - 1U) {
            print_block(path.name, (uint16_t)(index + 1U - VECTORS_BLOCK));
        }
    }
}

static uint8_t run_paths(uint8_t number, uint8_t count, path_getter_t *get, path_item_t *item)
{
    for (uint8_t which = 0; which < count; which++, number++) {
        if (detail_path == NONE || detail_path == number) {
            run_path(number, get(which), item, which);
        }
    }
    return number;
}

static void run(void)
{
    uint8_t number = 0;
    output_start();
#if !defined(VECTORS_FILTERS) || VECTORS_FILTERS
    (void)run_paths(number, filter_paths(), filter_path, filter_path_item);
#endif
    number = (uint8_t)(number + filter_paths());
#if !defined(VECTORS_FILTERS) || !VECTORS_FILTERS
    number = run_paths(number, primitive_paths(), primitive_path, primitive_path_item);
    number = run_paths(number, other_paths(), other_path, other_path_item);
    (void)run_paths(number, text_paths(), text_path, text_path_item);
#endif
    output_text("end\n");
    output_end();
}

#ifdef __AVR__
int main(void)
{
    _delay_ms(DETAIL_WAIT_MS);
    run();
    return 0;
}
#else
int main(int argc, char **argv)
{
    if (argc == 3) {
        detail_path = (uint8_t)atoi(argv[1]);
        detail_block = (uint8_t)atoi(argv[2]);
    }
    run();
    return 0;
}
#endif
