// Which filters of FILTER_LIST are paper 002's: all but those named here.
#ifndef PAPERS_SCOPE_H
#define PAPERS_SCOPE_H

#include <string>

namespace papers
{
inline bool of_paper_002(const std::string &name)
{
    return name != "synth"; // paper 000
}
} // namespace papers

#endif
