/*
 * One image of STORE_IMAGE_SIZE bytes in the EEPROM, whole after a power cut at any moment. What the bytes mean is the
 * caller's. Main only; nothing here waits, but for store_load.
 *
 * Two copies, each of mark, version, sequence, image and two check bytes. A save goes to the copy that store_load would
 * not take. Its mark, the length of its image, becomes STORE_OPEN first and is read back: from then on that copy is no
 * copy whatever the rest of it says. Version, sequence, image and check follow, then the mark again. A cut therefore
 * leaves the other copy as it was, and this one open or whole: nothing rests on a check happening not to fit. Where the
 * mark itself is torn, the rest of its copy is of one save.
 *
 * The check is a cyclic code over bytes, not bits (store.c): it finds every damage to one or two bytes of a copy,
 * whatever they have become, and misses one in 65,536 of greater ones. Of as many copies whose mark has become another
 * length, one is told as STORE_OTHER_VERSION instead of as damaged; none is taken for ours.
 */
#ifndef STORE_H
#define STORE_H

#include <stdbool.h>
#include <stdint.h>

#define STORE_IMAGE_SIZE 64u /* at most STORE_LENGTH_MAX */
#define STORE_VERSION 1u     /* to be raised when the image's bytes get another meaning: 0..254 */

#define STORE_LENGTH_MAX 120u
#define STORE_OPEN 0xFFu /* the mark of a copy that is being written, or never was */

/* Where the copies are. Address 0 stays free: supply that fails slowly can make a write go there. */
#define STORE_COPY_0 0x100u
#define STORE_COPY_1 0x200u

typedef enum {
    STORE_EMPTY,        /* nothing was ever saved: defaults */
    STORE_GOOD,         /* the image is the last one saved */
    STORE_OTHER_COPY,   /* the image is of one copy; the other is damaged, or its save was cut short */
    STORE_DAMAGED,      /* no copy is whole: defaults */
    STORE_OTHER_VERSION /* what is whole was saved by firmware with another image: defaults */
} store_status_t;

/*
 * At start-up, before anything else here: fills image[0..STORE_IMAGE_SIZE - 1] for STORE_GOOD and STORE_OTHER_COPY,
 * else leaves it as it is. Waits for a write that was under way when the processor was reset: 3.4 ms at most.
 */
store_status_t store_load(uint8_t *image);

/*
 * Begins to save image[0..STORE_IMAGE_SIZE - 1], which is read while store_busy(); if it changes meanwhile, the save
 * fails and the last one stays. False, and nothing is done, while one is under way. Takes 0.4 ms.
 */
bool store_save_begin(const uint8_t *image);

/*
 * One byte of the save, if the EEPROM is ready: steps over one that is right, or begins to write it. True when more
 * can be done at once; false when it waits for the EEPROM or nothing is left to do. To be called from the main loop.
 */
bool store_pass(void);

/* A save is under way. */
bool store_busy(void);

/* The last save did not get through (a cell that does not take its byte): what was saved before it stays in force. */
bool store_failed(void);

#endif
