/* The firmware's sample path for tests that drive it themselves, without a board around it. */
#ifndef SUPPORT_PATH_H
#define SUPPORT_PATH_H

#include <stdint.h>

/* A cold start as shipped, but for filter, output data rate and range; the next sample may come from `t_us` on. */
void path_start(uint8_t kind, uint16_t rate_dhz, uint8_t range_g, uint32_t t_us);

#endif
