/* The texts as packed in reply_packed.h, and the names of the commands, which are also compared and so not packed. */
#include "console/reply_texts.h"

#include "base/notices.h"
#include "base/text.h"
#include "console/reply_lines.h"
#include "console/reply_packed.h"
#include "machine.h"

/* The banner, which is no command, has the empty name. */
#define NO_NAME(...)
#define NAME(kind, typed, ...) "\0" typed
static const char names[] IN_FLASH = REPLIES(NO_NAME, NAME);

#define NO_COMMAND(...)
#define COMMAND_NTH(kind, ...) NTH_##kind,
enum { NTH_BANNER, REPLIES(NO_COMMAND, COMMAND_NTH) NTH_END };
_Static_assert(NOTICE_BANNER == (int)NTH_BANNER && NOTICE_LISTING + 1 == (int)NTH_END,
               "the commands follow the banner");

_Static_assert((int)PACKED_DEPTH <= (int)REPLY_PAIRS_DEPTH, "room for the pairs in a pair");
_Static_assert(PACKED_PAIR_FIRST == SAY_PAIR, "the codes of pairs follow those of values");

flash_text_t reply_command_name(uint8_t kind)
{
    return text_nth(names, kind);
}

const uint8_t *reply_text(uint8_t text)
{
    const uint8_t *start = packed_texts + flash_u16(&packed_starts[text / PACKED_STEP]);
    return (const uint8_t *)text_nth((flash_text_t)start, text % PACKED_STEP);
}

uint8_t reply_pair(uint8_t code, uint8_t half)
{
    return flash_u8(packed_pairs + 2u * (uint8_t)(code - PACKED_PAIR_FIRST) + half);
}
