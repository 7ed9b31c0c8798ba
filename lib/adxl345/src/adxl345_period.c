#include "adxl345_period.h"

#include "adxl345.h"
#include "machine.h"

enum { STEPS = 16 };

static struct period {
    uint32_t us_q8;
    uint32_t shortest_us; /* what may be a step between two samples: from here on */
    uint16_t step_span_us;
    uint32_t newest_us;
    uint32_t measured_from_us;
    uint8_t steps; /* since then, and one; 0: that stamp is not exact */
    bool measured;
} period;

/* Known by its address in a register, an access to it is half as long. */
static inline struct period *here(void)
{
    struct period *p = &period;
    MACHINE_POINTER(p);
    return p;
}

void adxl345_period_start(uint16_t half_us)
{
    struct period *p = here();
    uint32_t nominal_us = (uint32_t)half_us * 2u;
    p->us_q8 = nominal_us << 8;
    p->step_span_us = half_us >> 1;
    p->shortest_us = nominal_us - (half_us >> 2);
    p->steps = 0;
    p->measured = false;
}

/*
 * The mean of STEPS steps in a row between stamps that are exact, each within an eighth of the nominal one: that takes
 * less time for a sample than a mean that follows each, and does not hang half a microsecond beside the truth.
 */
void adxl345_period_sample(uint32_t t_us, bool exact)
{
    struct period *p = here();
    uint32_t step_us = t_us - p->newest_us;
    p->newest_us = t_us;
    if (p->steps != 0 && exact && step_us - p->shortest_us <= p->step_span_us) {
        if (p->steps != STEPS) {
            p->steps++;
            return;
        }
        p->us_q8 = (t_us - p->measured_from_us) * (256u / STEPS);
        p->measured = true;
    }
    p->steps = exact;
    p->measured_from_us = t_us;
}

MACHINE_APART uint32_t adxl345_period_us(void)
{
    return period.us_q8 >> 8;
}

uint32_t adxl345_period_us_q8(void)
{
    return period.us_q8;
}

bool adxl345_period_measured(void)
{
    return period.measured;
}
