/*
 * One record in the EEPROM, whole after a power cut at any moment: an image of STORE_IMAGE_SIZE bytes, whose meaning is
 * the caller's, and after it STORE_TAIL_SIZE bytes of the store's own. Main only; nothing waits here, but store_load.
 *
 * The EEPROM holds two copies. A save goes to the one that store_load would not take. That one's mark, its last byte,
 * first becomes STORE_OPEN and is read back: from then on it is no copy, whatever the rest of it says. Image, version,
 * sequence number and check follow, each byte read back; then the mark becomes STORE_IMAGE_SIZE. So whatever byte a cut
 * leaves, erased, old, new or anything, the other copy is as it was and this one open or whole, and nothing rests on a
 * check happening not to fit. A mark that is torn stands with bytes that are all of one save: the copy's older one
 * while it opens, the new one while it closes. When that happens again as the next save opens this copy again, and the
 * torn mark then reads as right (1 in 256), the set of the save that was cut first is the one that counts: whole, too.
 *
 * The check (store.c) finds every damage to one or two bytes of a copy, whatever they have become, and misses one in
 * 65,536 of greater ones.
 */
#ifndef STORE_H
#define STORE_H

#include <stdbool.h>
#include <stdint.h>

/*
 * The same for all versions that are to be told as such: what was saved with another size is told as damaged. So have
 * it large enough from the beginning, 2 to STORE_IMAGE_MAX, and raise the version when the bytes get another meaning.
 */
#define STORE_IMAGE_SIZE 76u
#define STORE_IMAGE_MAX 120u
#define STORE_VERSION 2u /* 0..254 */

#define STORE_TAIL_SIZE 5u /* version, sequence number, two of the check, mark */
#define STORE_RECORD_SIZE (STORE_IMAGE_SIZE + STORE_TAIL_SIZE)

#define STORE_OPEN 0xFFu /* the mark of a copy that is being written, or never was */

/* Where the copies are. Address 0 stays free: a write that goes astray as the supply fails goes there. */
#define STORE_COPY_0 0x100u
#define STORE_COPY_1 0x200u

typedef enum {                      /* of two copies the greater one counts, of equal ones the later */
               STORE_DAMAGED,       /* no copy is whole: damaged, or the first save was cut short */
               STORE_EMPTY,         /* nothing was ever saved */
               STORE_OTHER_VERSION, /* what is whole was saved with another STORE_VERSION */
               STORE_GOOD,          /* the image is the last one saved */
               STORE_OTHER_COPY     /* the image is of one copy; the other is damaged, or its save was cut short */
} store_status_t;

/*
 * At start-up, before anything else here, and later while no save is under way. The record must stay where it is: the
 * store goes on using it, and nobody else changes its tail. From STORE_GOOD on its image is what was saved; else it is
 * junk, the caller puts his defaults there. Waits for a write that was under way when the processor was reset, 3.4 ms
 * at most.
 */
store_status_t store_load(uint8_t record[STORE_RECORD_SIZE]);

/*
 * Begins to save the record's image, which is read while store_busy(): if it changes meanwhile the save fails, or a
 * later store_load takes the set before it. False, and nothing done, while a save is under way. Takes 0.05 ms.
 */
bool store_save_begin(void);

/*
 * One byte of the save, if the EEPROM is ready: steps over one that is right, or begins to write it. True when more
 * can be done at once; false when it waits for the EEPROM or nothing is left to do. To be called from the main loop.
 */
bool store_pass(void);

/* A save is under way. */
bool store_busy(void);

/*
 * The last save did not get through: a cell did not take its byte, or the image changed. What was saved before it stays
 * in force, and store_load will tell the copy that it went to as damaged.
 */
bool store_failed(void);

#endif
