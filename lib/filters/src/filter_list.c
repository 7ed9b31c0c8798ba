/* The laws of the list by number and by name: see filter_list.h. */
#include "filter_list.h"

#include "machine.h"

static const filter_law_t *const laws[FILTER_KIND_COUNT] IN_FLASH = {
#define LISTED(F) [FILTER_KIND_##F] = &filter_law_##F,
    FILTER_LINKED(LISTED)
#undef LISTED
};

const filter_law_t *filter_listed(filter_kind_t kind)
{
    if (kind >= FILTER_KIND_COUNT) {
        return NULL;
    }
    return (const filter_law_t *)flash_pointer(&laws[kind]);
}

/* Separate from the descriptors: includes laws that are not linked. */
static const char names[FILTER_KIND_COUNT][12] IN_FLASH = {
#define NAME(F) #F,
    FILTER_LIST(NAME)
#undef NAME
};

const char *filter_listed_name(filter_kind_t kind)
{
    return names[kind];
}

/* Whether a text in RAM equals one in program memory. */
static bool same_text(const char *ram, const char *flash)
{
    for (;; ram++, flash++) {
        char c = (char)flash_u8((const uint8_t *)flash);
        if (*ram != c) {
            return false;
        }
        if (c == '\0') {
            return true;
        }
    }
}

filter_kind_t filter_find(const char *name)
{
    for (uint8_t kind = 0; kind < (uint8_t)FILTER_KIND_COUNT; kind++) {
        if (same_text(name, names[kind])) {
            return (filter_kind_t)kind;
        }
    }
    return FILTER_KIND_COUNT;
}
