/* A law of lib/filters at 100 Hz as it is shipped, told the noise of the stream. */
#include "filter.h"
#include "peer.h"

/* Compiled alone, as by make check, any name does. */
#ifndef PEER_LAW
#define PEER_LAW filter_law_by_name
#endif
extern const filter_law_t PEER_LAW;

PEER_LSB_TO_FIX16

static filter_t state;

void peer_start(void)
{
    filter_config_t config = filter_defaults(&PEER_LAW, 1000);
    for (uint8_t i = 0; i < filter_parameter_count(&PEER_LAW); i++) {
        if (filter_parameter(&PEER_LAW, i) == &filter_parameter_r) {
            config.value[i] = (int32_t)(PEER_R * 256.0f);
        }
    }
    (void)filter_init(&state, &PEER_LAW, &config);
}

void peer_step(void)
{
    x = filter_update(&state, z);
}
