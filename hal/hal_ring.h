/*
 * Byte ring for one producer and one consumer, one of them an interrupt: each index has one owner and is one byte, so
 * no critical section is needed. The size is a power of two up to 256; mask is the size - 1. One slot stays free to
 * distinguish full from empty. The producer works on `staged` and publishes it with hal_ring_commit. A byte is in the
 * buffer before the index says so, and is read before its slot is freed: HAL_RING_FENCE keeps the compiler from
 * swapping the two.
 */
#ifndef HAL_RING_H
#define HAL_RING_H

#include <stdbool.h>
#include <stdint.h>

#define HAL_RING_FENCE() __asm__ volatile("" ::: "memory")

typedef struct {
    volatile uint8_t head; /* producer: first free slot as the consumer sees it */
    volatile uint8_t tail; /* consumer: next byte to take */
    uint8_t staged;        /* producer: first free slot as the producer sees it */
} hal_ring_t;

static inline uint8_t hal_ring_room(const hal_ring_t *r, uint8_t mask)
{
    uint8_t used = (uint8_t)((uint8_t)(r->staged - r->tail) & mask);
    return (uint8_t)(mask - used);
}

static inline bool hal_ring_empty(const hal_ring_t *r)
{
    return r->head == r->tail;
}

static inline void hal_ring_stage(hal_ring_t *r, uint8_t *buffer, uint8_t mask, uint8_t byte)
{
    uint8_t at = r->staged;
    buffer[at] = byte;
    r->staged = (uint8_t)((uint8_t)(at + 1u) & mask);
}

static inline void hal_ring_commit(hal_ring_t *r)
{
    HAL_RING_FENCE();
    r->head = r->staged;
}

static inline void hal_ring_discard(hal_ring_t *r)
{
    r->staged = r->head;
}

/* The ring must not be empty. */
static inline uint8_t hal_ring_take(hal_ring_t *r, const uint8_t *buffer, uint8_t mask)
{
    uint8_t at = r->tail;
    HAL_RING_FENCE();
    uint8_t byte = buffer[at];
    HAL_RING_FENCE();
    r->tail = (uint8_t)((uint8_t)(at + 1u) & mask);
    return byte;
}

#endif
