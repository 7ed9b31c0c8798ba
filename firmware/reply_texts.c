/* One block of texts and where each begins in it. */
#include "reply_texts.h"

#include <stddef.h>

#include "fx.h"

#define PLACE(name, words) char name[sizeof(words)];
#define WORDS(name, words) words,
#define START(name, words) offsetof(struct texts, name),

static const struct texts {
    REPLY_TEXTS(PLACE)
} texts FLASH = { REPLY_TEXTS(WORDS) };

static const uint16_t starts[] FLASH = { REPLY_TEXTS(START) };

FX_ONCE flash_text_t reply_text(uint8_t id)
{
    return (flash_text_t)&texts + flash_u16(&starts[id]);
}
