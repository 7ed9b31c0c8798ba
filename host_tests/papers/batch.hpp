// A shipped filter for the experiments that are in Python.
#ifndef PAPERS_BATCH_H
#define PAPERS_BATCH_H

extern "C" {
#include "support/filters.h"
}

namespace papers
{
// With parameters by their names in the descriptor; r may be given to a filter without one. NULL, or what is wrong.
const char *begun(const char *name, int rate_dhz, int count, const char *const *names, const double *values,
                  filter_t *f);
} // namespace papers

#endif
