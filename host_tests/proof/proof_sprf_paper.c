/* sprf_paper: see law.h; its report is wide_report. */
#define KEPT WIDE_PARAMETERS
#include "wide_bounds.h"

#include "sprf_paper.c"

static void any_own(filter_t *f, uint8_t kind)
{
    (void)kind;
    any_wide(f);
}

/* Uses: fx_normalise, rounded, wide_set_noise */
PROVE(set_up, sprf_paper)
/* Options: -no-warn-signed-downcast */
PROVE(defaults, sprf_paper)
/* Uses: wide_set_noise */
PROVE(set_noise, sprf_paper)
/* Uses: fx_normalise, rounded */
PROVE(start, sprf_paper)
/* Uses: wide_predict, wide_distance_uq8, wide_correct */
PROVE(step, sprf_paper)
PROVE(fade, sprf_paper)
