// Which filters of FILTER_LIST are paper 002's: those whose model it is, a position with a rate that is driven by white
// acceleration of the power density q.
#ifndef PAPERS_SCOPE_H
#define PAPERS_SCOPE_H

#include <string>

extern "C" {
#include "filter_list.h"
#include "tracker.h"
}

namespace papers
{
inline bool of_paper_002(const std::string &name)
{
    const filter_kind_t kind = filter_find(name.c_str());
    const filter_law_t *law = (kind == FILTER_KIND_COUNT) ? nullptr : filter_listed(kind);
    for (int i = 0; law != nullptr && i < law->parameter_count; i++) {
        if (law->parameters[i] == &filter_parameter_q) {
            return true;
        }
    }
    return false;
}
} // namespace papers

#endif
