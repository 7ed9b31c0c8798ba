/* The texts as reply_packed.h has them, and the names of the commands, which are compared too and so are not packed. */
#include "reply_texts.h"

#include "flash.h"
#include "fx.h"
#include "reply_packed.h"

#define NAME_ROOM(name) sizeof(name) > NAME_BYTES ||
#define NAME_BYTES 9

static const char names[][NAME_BYTES] FLASH = {
#define NAME(name) name,
    REPLY_NAMES(NAME)
#undef NAME
};
_Static_assert(!(REPLY_NAMES(NAME_ROOM) 0), "a name with its end fits");

static const uint8_t *at;
static uint8_t waiting[PACKED_DEPTH];
static uint8_t depth;

flash_text_t reply_name(uint8_t command)
{
    return names[command];
}

void reply_text_open(uint8_t id)
{
    at = packed_texts + flash_u16(&packed_starts[id / PACKED_STEP]);
    depth = 0;
    for (uint8_t ends = id % PACKED_STEP; ends != 0; at++) {
        if (flash_u8(at) == 0) {
            ends--;
        }
    }
}

FX_ONCE uint8_t reply_text_next(void)
{
    uint8_t code = depth != 0 ? waiting[--depth] : flash_u8(at++);
    while (code >= PACKED_PAIR_FIRST) {
        const uint8_t *pair = packed_pairs + 2u * (uint8_t)(code - PACKED_PAIR_FIRST);
        waiting[depth++] = flash_u8(pair + 1);
        code = flash_u8(pair);
    }
    return code;
}
