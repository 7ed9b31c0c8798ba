/*
 * Not run, read: two bytes through a ring of one slot. The compiler sees that the second one goes where the first was,
 * and leaves the first out unless the ring says that somebody looks in between.
 */
#include "hal_ring.h"

enum { FIRST = 0x55, SECOND = 0xAA };

hal_ring_t ring;
uint8_t slot[1];

void two_in(void);
void two_in(void)
{
    ring.staged = 0;
    hal_ring_stage(&ring, slot, 0, FIRST);
    hal_ring_commit(&ring);
    hal_ring_stage(&ring, slot, 0, SECOND);
    hal_ring_commit(&ring);
}
