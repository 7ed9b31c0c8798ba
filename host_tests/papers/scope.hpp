// Which filters of FILTER_LIST are paper 002's: all but those named here, which are of papers 000 and 001.
#ifndef PAPERS_SCOPE_H
#define PAPERS_SCOPE_H

#include <algorithm>
#include <array>
#include <string>

namespace papers
{
inline bool of_paper_002(const std::string &name)
{
    constexpr std::array<const char *, 6> others{ "synth", "synth_opt", "synth_plus", "adaptive", "kf3", "auto" };
    return std::find(others.begin(), others.end(), name) == others.end();
}
} // namespace papers

#endif
