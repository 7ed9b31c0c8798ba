/*
 * A filter on the chip beside others, for peer_run.c: what an adapter has. Test only. Other people's libraries are in
 * no folder of this repository: campaigns/bench/bench_peers.py says where it finds them.
 */
#ifndef PEER_H
#define PEER_H

#include <stdint.h>

/*
 * What every Kalman filter of position and rate is told: variances of a sample (LSB^2, that of the stream), of the
 * rate's growth in a sample and of the rate at the start ((LSB per sample)^2, those of kalman.c at 100 Hz).
 */
#define PEER_R 16.0f
#define PEER_Q 0.01f
#define PEER_RATE_VARIANCE 4.0f

#ifdef __cplusplus
extern "C" {
#endif

/* How to read the bits of an estimate in LSB: 'f' float, 'q' Q16.16, 'i' int16. */
extern const char peer_kind;

void peer_start(void);

/* The next sample, in the format that the filter takes: converting it is not timed. */
void peer_take(int16_t z_lsb);

/* It through the filter, and the estimate put away. */
void peer_step(void);

/* The same loads and stores without a filter. */
void peer_nothing(void);

uint32_t peer_bits(void);

#ifdef __cplusplus
}
#endif

/* All of them but start and step, of a filter that takes z and gives x. */
#define PEER(TAKES, PER_LSB, GIVES, KIND)             \
    static volatile TAKES z;                          \
    static volatile GIVES x;                          \
    const char peer_kind = KIND;                      \
    void peer_take(int16_t z_lsb)                     \
    {                                                 \
        z = (TAKES)((TAKES)z_lsb * (TAKES)(PER_LSB)); \
    }                                                 \
    void peer_nothing(void)                           \
    {                                                 \
        (void)z;                                      \
        x = 0;                                        \
    }                                                 \
    uint32_t peer_bits(void)                          \
    {                                                 \
        union {                                       \
            GIVES value;                              \
            uint32_t bits;                            \
        } estimate;                                   \
        estimate.bits = 0;                            \
        estimate.value = x;                           \
        return estimate.bits;                         \
    }

#define PEER_FLOAT PEER(float, 1, float, 'f')
#define PEER_FIX16 PEER(int32_t, 65536, int32_t, 'q')
#define PEER_LSB_TO_FIX16 PEER(int16_t, 1, int32_t, 'q')
#define PEER_LSB_TO_FLOAT PEER(int16_t, 1, float, 'f')
#define PEER_LSB PEER(int16_t, 1, int16_t, 'i')

#endif
