/*
 * Runs on the ATmega328P (simavr): one filter over one stream, by its adapter (peer.h). On the UART (1 Mbaud), for
 * bench_peers.py: the kind of its estimates, then for each sample 12 hexadecimal digits: cycles of the call
 * (those of an empty one taken off; ffff: more than the timer counts), bits of the estimate.
 */
#include "bench_call.h"
#include "peer.h"

/* campaigns/bench/bench_peers.py writes them. */
extern const int16_t peer_stream[];
extern const uint16_t peer_stream_count;

static uint16_t cycles_of(void (*call)(void))
{
    TCNT1 = 0; /* it must not overflow between the next line and the call */
    TIFR1 = _BV(TOV1);
    uint16_t cycles = timed(call);
    return (TIFR1 & _BV(TOV1)) != 0U ? UINT16_MAX : cycles;
}

int main(void)
{
    begin_measuring();
    uint16_t empty = cycles_of(peer_nothing);
    peer_start();
    put('=');
    put(peer_kind);
    put('\n');
    for (uint16_t n = 0; n < peer_stream_count; n++) {
        peer_take((int16_t)pgm_read_word(&peer_stream[n]));
        uint16_t cycles = cycles_of(peer_step);
        put_hex(cycles == UINT16_MAX ? cycles : (uint16_t)(cycles - empty));
        uint32_t bits = peer_bits();
        put_hex((uint16_t)(bits >> 16));
        put_hex((uint16_t)bits);
        put('\n');
    }
    end_measuring();
    for (;;) {
    }
}
