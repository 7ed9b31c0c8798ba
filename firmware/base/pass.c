#include "base/pass.h"

#include "hal_time.h"

static uint8_t began; /* hal_time_lap */

void pass_begin(void)
{
    began = hal_time_lap();
}

bool pass_in_time(void)
{
    return (uint8_t)(hal_time_lap() - began) < PASS_US / HAL_LAP_US;
}
