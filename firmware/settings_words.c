/* See settings_words.h. */
#include "settings_words.h"

#include "text.h"

#define NAME(F) #F "\0"
static const char words[] FLASH = FILTER_LIST(NAME) "csv\0plot\0auto\0"
                                                    "53\0"
                                                    "1D";

flash_text_t settings_word(uint8_t place)
{
    return text_nth(words, place);
}
