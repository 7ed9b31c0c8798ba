/* The yardstick by hand: two states, a full 2x2 covariance, float, from the textbook (float_kf.c). */
#include "float_filters.h"
#include "peer.h"

PEER_LSB_TO_FLOAT

void peer_start(void)
{
    filter_config_t config = { .rate_dhz = 1000 };
    config.value[KF_R_LSB2_Q8] = (int32_t)(PEER_R * 256.0f);
    config.value[KF_Q_LSB2_S3] = (int32_t)(PEER_Q * 1e6f);
    float_kf_start(&float_kf, &config, 0.0f);
}

void peer_step(void)
{
    x = float_kf_update(&float_kf, z);
}
