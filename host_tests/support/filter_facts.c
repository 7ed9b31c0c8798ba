/* The facts about the laws of the list that no descriptor tells: each stand with the law. */
#include "support/filters.h"

/* A law without its facts does not link. */
law_facts_t law_facts(filter_kind_t kind)
{
    switch (kind) {
#define ROW(F)            \
    case FILTER_KIND_##F: \
        return law_facts_##F();
        FILTER_LIST(ROW)
#undef ROW
    case FILTER_KIND_COUNT:
        break;
    }
    return (law_facts_t){ 0 };
}
