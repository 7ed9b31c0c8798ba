/* sprf_paper: see law.h; its report is filter_wide_report. */
#define KEPT WIDE_PARAMETERS
#include "wide_bounds.h"

#include "sprf_paper.c"

static void any_own(filter_t *f, uint8_t kind)
{
    (void)kind;
    any_wide(f);
}

PROVE_LAW(sprf_paper)
