/*
 * The laws that a program offers by name: X(name), by default all of filter.h; the firmware starts with the first. A
 * build without room for all names its own: -D'FILTER_LIST(X)=X(kf) X(sprf)'.
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

/* The laws that are linked: fewer where a program over the whole list has no room for all (tests on the chip). */
#ifndef FILTER_LINKED
#define FILTER_LINKED(X) FILTER_LIST(X)
#endif

typedef enum {
#define FILTER_ENUM(F) FILTER_KIND_##F,
    FILTER_LIST(FILTER_ENUM)
#undef FILTER_ENUM
        FILTER_KIND_COUNT
} filter_kind_t;

/* The law of a kind; NULL if it is not linked or the kind is unknown. */
const filter_law_t *filter_listed(filter_kind_t kind);

/* Its name, in program memory, whether linked or not. */
const char *filter_listed_name(filter_kind_t kind);

/* The kind whose name equals the text (RAM, NUL-terminated); FILTER_KIND_COUNT if none does. */
filter_kind_t filter_find(const char *name);

#ifdef __cplusplus
}
#endif
#endif
