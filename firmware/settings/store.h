/*
 * One record in the EEPROM, intact after a power cut at any moment: an image of STORE_IMAGE_SIZE bytes, whose meaning
 * is the caller's, followed by STORE_TAIL_SIZE bytes of the store's own. Main only; nothing waits here except
 * store_load.
 *
 * The EEPROM holds two copies. A save goes to the one that store_load would not take. Its mark, its last byte, first
 * becomes STORE_OPEN and is read back: from then on it is not a valid copy, whatever else it holds. Image, version,
 * sequence number and check follow, each byte read back; then the mark becomes STORE_IMAGE_SIZE. So whatever byte a
 * power cut leaves, erased, old, new or any other, the other copy is unchanged and this one is open or intact, and
 * nothing relies on a check to fail by luck. A torn mark has only bytes of a single save before it: of the copy's older
 * save while the copy opens, of the new one while it closes. If the mark is torn again when the next save opens this
 * copy, and then reads as valid (1 in 256), the save that was cut first is in force: it is intact, too.
 *
 * The check (store.c) detects all damage to one or two bytes of a copy, whatever their values become, and misses one in
 * 65,536 cases of greater damage.
 */
#ifndef STORE_H
#define STORE_H

#include <stdbool.h>
#include <stdint.h>

/*
 * The same for all versions that are to be recognised as such: what was saved with another size is reported as damaged.
 * So make it large enough from the start, 2 to STORE_IMAGE_MAX, and raise the version when the bytes change their
 * meaning.
 */
#define STORE_IMAGE_SIZE 76u
#define STORE_IMAGE_MAX 120u
#define STORE_VERSION 2u /* 0..254 */

#define STORE_TAIL_SIZE 5u /* version, sequence number, two check bytes, mark */
#define STORE_RECORD_SIZE (STORE_IMAGE_SIZE + STORE_TAIL_SIZE)

#define STORE_OPEN 0xFFu /* the mark of a copy that is being written, or never was */

/* Addresses of the copies. Address 0 stays unused: a write that goes astray while the supply fails goes there. */
#define STORE_COPY_0 0x100u
#define STORE_COPY_1 0x200u

/* Of two copies the one with the greater status is in force; of equal ones the later. */
typedef enum {
    STORE_DAMAGED,       /* no copy is intact: damaged, or the first save was cut short */
    STORE_EMPTY,         /* nothing was ever saved */
    STORE_OTHER_VERSION, /* the intact copy was saved with another STORE_VERSION */
    STORE_GOOD,          /* the image is the last one saved */
    STORE_OTHER_COPY     /* the image is that of one copy; the other is damaged, or its save was cut short */
} store_status_t;

/*
 * Call at start-up, before anything else here; later only while no save is in progress. The record must stay in place:
 * the store keeps using it, and nobody else changes its tail. From STORE_GOOD on, its image is what was saved;
 * otherwise it is garbage, and the caller puts defaults there. Waits for a write that was in progress when the
 * processor was reset, 3.4 ms at most.
 */
store_status_t store_load(uint8_t record[STORE_RECORD_SIZE]);

/*
 * Starts to save the record's image, which is read while store_busy(): if it changes meanwhile, the save fails, or a
 * later store_load takes the save before it. False, and nothing is done, while a save is in progress. Takes 0.05 ms.
 */
bool store_save_begin(void);

/*
 * One byte of the save, if the EEPROM is ready: skips it if it is right, or starts to write it. True if more can be
 * done at once; false if it waits for the EEPROM or nothing is left to do. Call from the main loop.
 */
bool store_pass(void);

/* A save is in progress. */
bool store_busy(void);

/*
 * The last save failed: a cell did not take its byte, or the image changed. What was saved before it stays in force,
 * and store_load will report the copy that it went to as damaged.
 */
bool store_failed(void);

#endif
