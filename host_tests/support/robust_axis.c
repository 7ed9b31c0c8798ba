#include "support/robust_axis.h"

#include "support/roles.h"
#include "tracker.h"

#include <math.h>

#define START_LSB_S 200.0 /* deviation of the rate at the start, as kalman.c */

void robust_axis_begin(robust_axis_t *of, robust_kind_t kind, uint16_t rate_dhz, int axis)
{
    const filter_law_t *plain = filter_listed(plain_kind());
    const filter_config_t config = filter_defaults(plain, rate_dhz);
    double rate_hz = rate_dhz / 10.0;
    double q = 0.0;
    for (uint8_t i = 0; i < filter_parameter_count(plain); i++) {
        if (filter_parameter(plain, i) == &filter_parameter_q) {
            q = ldexp(config.value[i], -filter_parameter_q.fraction_bits) / pow(rate_hz, 3.0);
        }
    }
    filter_noise_init(&of->noise, rate_dhz, axis == 2);
    robust_peer_begin(&of->peer, kind, filter_noise_r_lsb2_q8(&of->noise) / 256.0, q, pow(START_LSB_S / rate_hz, 2.0));
}

double robust_axis_sample(robust_axis_t *of, int16_t z_lsb)
{
    (void)filter_noise_update(&of->noise, z_lsb);
    of->peer.r = filter_noise_r_lsb2_q8(&of->noise) / 256.0;
    return robust_peer_sample(&of->peer, z_lsb);
}
