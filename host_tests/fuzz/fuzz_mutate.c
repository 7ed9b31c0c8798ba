/* Changes to an input, one function each; mutate_once takes one of them at random. */
#include <stdbool.h>
#include <string.h>

#include "fuzz_drive.h"

enum { PIECE_MAX = 64 };

/* One change in the making: the place, what follows it, how much may be put in, and how long a piece was drawn. */
typedef struct {
    current_t *input;
    const blob_t *other;
    size_t at;
    size_t rest;
    size_t room;
    size_t size;
} change_t;

static uint64_t random_state = 1;

void mutate_seed(uint64_t seed)
{
    random_state = seed * 2654435769u + 88172645463325252u;
}

static uint32_t random_u32(void)
{
    random_state ^= random_state >> 12;
    random_state ^= random_state << 25;
    random_state ^= random_state >> 27;
    return (uint32_t)((random_state * 2685821657736338717u) >> 32);
}

size_t mutate_below(size_t end)
{
    return end == 0 ? 0 : (size_t)(((uint64_t)random_u32() * end) >> 32);
}

static size_t lesser(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Makes room for `size` bytes in the place of `cut`; false, and nothing done, when the input would become too long. */
static bool open_gap(change_t *c, size_t cut, size_t size)
{
    size_t tail = c->rest - cut;
    if (c->at + size + tail > INPUT_MAX) {
        return false;
    }
    memmove(&c->input->bytes[c->at + size], &c->input->bytes[c->at + cut], tail);
    c->input->size = (uint32_t)(c->at + size + tail);
    return true;
}

static void put(change_t *c, size_t cut, const uint8_t *bytes, size_t size)
{
    if (open_gap(c, cut, size)) {
        memcpy(&c->input->bytes[c->at], bytes, size);
    }
}

static void take_out(change_t *c)
{
    (void)open_gap(c, lesser(c->size, c->rest), 0);
}

static void double_own_piece(change_t *c)
{
    uint8_t piece[PIECE_MAX];
    size_t size = lesser(c->size, c->rest);
    size = size < c->room ? size : 0;
    memcpy(piece, &c->input->bytes[c->at], size);
    put(c, 0, piece, size);
}

/* In the place of as much, or between; nothing of it where there is no room. */
static void put_piece(change_t *c, const uint8_t *bytes, size_t size)
{
    size_t cut = mutate_below(2) == 0 && size <= c->rest ? size : 0;
    put(c, cut, bytes, size < c->room ? size : 0);
}

static void piece_of_another(change_t *c)
{
    size_t from = mutate_below(c->other->size);
    put_piece(c, &c->other->bytes[from], lesser(c->size, c->other->size - from));
}

static void one_byte_repeated(change_t *c)
{
    uint8_t byte = c->rest != 0 ? c->input->bytes[c->at] : (uint8_t)random_u32();
    size_t size = c->size < c->room ? c->size : 0;
    if (open_gap(c, 0, size)) {
        memset(&c->input->bytes[c->at], byte, size);
    }
}

static void word_of_dictionary(change_t *c)
{
    const blob_t *word = dictionary_word();
    if (word == NULL) {
        one_byte_repeated(c);
        return;
    }
    put_piece(c, word->bytes, word->size);
}

static void new_byte(change_t *c)
{
    uint8_t byte = (uint8_t)random_u32();
    put(c, 0, &byte, c->room != 0);
}

static void change_byte(change_t *c)
{
    static const uint8_t edge[] = { 0, 1, 0x7F, 0x80, 0xFF, ' ', '0', '9', '\n', ',' };
    uint8_t *byte = &c->input->bytes[c->at];
    if (c->rest == 0) {
        return;
    }
    switch (mutate_below(4)) {
    case 0:
        *byte ^= (uint8_t)(1u << mutate_below(8));
        break;
    case 1:
        *byte = (uint8_t)(*byte + mutate_below(33) - 16);
        break;
    case 2:
        *byte = edge[mutate_below(sizeof edge)];
        break;
    default:
        *byte = (uint8_t)random_u32();
        break;
    }
}

void mutate_once(current_t *input, const blob_t *others, size_t count, size_t length_max)
{
    /* a byte changed in place is the likeliest: two of eight */
    static void (*const change[])(change_t *) = { take_out,           double_own_piece,  piece_of_another,
                                                  word_of_dictionary, one_byte_repeated, new_byte,
                                                  change_byte,        change_byte };
    change_t c = { .input = input, .other = &others[mutate_below(count)], .at = mutate_below(input->size + 1u) };
    c.rest = input->size - c.at;
    c.room = length_max > input->size ? length_max - input->size : 0;
    c.size = mutate_below(1 + (mutate_below(4) == 0 ? PIECE_MAX : 8));
    change[mutate_below(sizeof change / sizeof change[0])](&c);
}
