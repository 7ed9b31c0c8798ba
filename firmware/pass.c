#include "pass.h"

#include "fx.h"

pass_t pass;

FX_ONCE bool pass_in_time(void)
{
    return (uint8_t)(hal_time_lap() - pass.began) < pass.limit;
}

FX_ONCE bool pass_early(void)
{
    return (uint8_t)(hal_time_lap() - pass.began) < PASS_EARLY_US / HAL_LAP_US;
}
