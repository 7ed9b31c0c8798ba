#include "adxl345_period.h"

#include "adxl345.h"
#include "machine.h"

enum { STEPS = 16 }; /* their sum is the period in 1/16 us */

static struct period {
    uint32_t us_q4;
    uint16_t half_us; /* half the nominal step */
    uint32_t newest_us;
    uint32_t measured_from_us;
    uint8_t steps; /* steps since then, plus one; 0: that stamp is not exact */
    bool measured;
} period;

/* With the address in a register, an access takes half the code. */
static inline struct period *here(void)
{
    struct period *p = &period;
    MACHINE_POINTER(p);
    return p;
}

void adxl345_period_start(uint16_t half_us)
{
    struct period *p = here();
    p->us_q4 = (uint32_t)half_us << 5;
    p->half_us = half_us;
    p->steps = 0;
    p->measured = false;
}

/* Within an eighth of the nominal period; a shorter step wraps and is far too long. */
static bool near_nominal(const struct period *p, uint32_t step_us)
{
    uint16_t half_us = p->half_us;
    return step_us - half_us - half_us + (half_us >> 2) <= half_us >> 1;
}

/*
 * The mean of STEPS consecutive steps between exact stamps, each near the nominal period. It costs less time per sample
 * than a running mean, and does not settle half a microsecond off the true value.
 */
void adxl345_period_sample(uint32_t t_us, bool exact)
{
    struct period *p = here();
    uint32_t step_us = t_us - p->newest_us;
    p->newest_us = t_us;
    if (p->steps != 0 && exact && near_nominal(p, step_us)) {
        if (p->steps != STEPS) {
            p->steps++;
            return;
        }
        p->us_q4 = t_us - p->measured_from_us;
        p->measured = true;
    }
    p->steps = exact;
    p->measured_from_us = t_us;
}

MACHINE_APART uint32_t adxl345_period_us(void)
{
    return period.us_q4 >> 4;
}

uint32_t adxl345_period_us_q4(void)
{
    return period.us_q4;
}

bool adxl345_period_measured(void)
{
    return period.measured;
}
