/* The texts as reply_packed.h has them, and the names of the commands, which are compared too and so are not packed. */
#include "reply_texts.h"

#include "flash.h"
#include "replies.h"
#include "reply_lines.h"
#include "reply_packed.h"

#define NAME_ROOM(name) sizeof(name) > NAME_BYTES ||
#define NAME_BYTES 9

static const char names[][NAME_BYTES] FLASH = {
#define NAME(name) name,
    REPLY_NAMES(NAME)
#undef NAME
};
_Static_assert(!(REPLY_NAMES(NAME_ROOM) 0), "a name with its end fits");
_Static_assert(sizeof names / sizeof names[0] == REPLY_LISTING - REPLY_HELP + 1, "a name for each command");
_Static_assert(PACKED_PAIR_FIRST == SAY_PAIR, "the codes of pairs follow those of values");

flash_text_t reply_command_name(uint8_t kind)
{
    return names[kind - REPLY_HELP];
}

const uint8_t *reply_text(uint8_t text)
{
    const uint8_t *at = packed_texts + flash_u16(&packed_starts[text / PACKED_STEP]);
    for (uint8_t ends = text % PACKED_STEP; ends != 0; at++) {
        if (flash_u8(at) == 0) {
            ends--;
        }
    }
    return at;
}

uint8_t reply_pair(uint8_t code, uint8_t half)
{
    return flash_u8(packed_pairs + 2u * (uint8_t)(code - PACKED_PAIR_FIRST) + half);
}
