/* See settings_words.h. */
#include "settings/settings_words.h"

#include "base/text.h"

static const char words[] IN_FLASH = "csv\0plot\0auto\0"
                                     "53\0"
                                     "1D\0auto\0"
                                     "100\0"
                                     "400";

flash_text_t settings_word(uint8_t place)
{
    if (place < WORD_MODE) {
        return filter_name(filter_listed((filter_kind_t)place));
    }
    return text_nth(words, (uint8_t)(place - WORD_MODE));
}
