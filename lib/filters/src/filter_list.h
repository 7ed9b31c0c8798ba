/*
 * The laws that a program wants by name: X(name), by default all of filter.h; the firmware starts with the first. A
 * build that has no room for all says which it wants: -D'FILTER_LIST(X)=X(kf) X(sprf)'.
 */
#ifndef FILTER_LIST_H
#define FILTER_LIST_H

#include "filter.h"

#ifdef __cplusplus
extern "C" {
#endif

#ifndef FILTER_LIST
#define FILTER_LIST(X) FILTER_LAWS(X)
#endif

/* Those that are linked: fewer where a program over the whole list has no room for all (tests on the chip). */
#ifndef FILTER_LINKED
#define FILTER_LINKED(X) FILTER_LIST(X)
#endif

typedef enum {
#define FILTER_ENUM(F) FILTER_KIND_##F,
    FILTER_LIST(FILTER_ENUM)
#undef FILTER_ENUM
        FILTER_KIND_COUNT
} filter_kind_t;

/* The law of a kind; NULL: not linked, or no kind. */
const filter_law_t *filter_listed(filter_kind_t kind);

/* Its name, in program memory, linked or not. */
const char *filter_listed_name(filter_kind_t kind);

/* Kind whose name equals the text (RAM, NUL-terminated); FILTER_KIND_COUNT when none does. */
filter_kind_t filter_find(const char *name);

#ifdef __cplusplus
}
#endif
#endif
