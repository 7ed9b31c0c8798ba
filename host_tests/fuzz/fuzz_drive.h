/*
 * What the pieces of the driver for gcc share (fuzz_drive.c, fuzz_mutate.c, fuzz_dictionary.c); libFuzzer uses none of
 * them.
 */
#ifndef FUZZ_DRIVE_H
#define FUZZ_DRIVE_H

#include <stddef.h>
#include <stdint.h>

enum { INPUT_MAX = 4096 };

typedef struct {
    uint8_t *bytes;
    size_t size;
} blob_t;

/* In shared memory, so that the input outlives the process. */
typedef struct {
    uint32_t size;
    uint8_t bytes[INPUT_MAX];
} current_t;

/* Says what the system reports of that path and ends with status 2. */
_Noreturn void fuzz_stop(const char *what, const char *path);

/* A copy of these bytes, for as long as the process lives. */
blob_t fuzz_kept(const uint8_t *bytes, size_t size);

void mutate_seed(uint64_t seed);

/* 0 <= result < end; 0 for end 0. */
size_t mutate_below(size_t end);

/* One change: up to length_max bytes stay, others[0 .. count - 1] lend pieces (count at least 1). */
void mutate_once(current_t *input, const blob_t *others, size_t count, size_t length_max);

/* Lines of the form "text" with \xNN; anything else is a comment. */
void dictionary_load(const char *path);

/* A word of the dictionary; NULL when there is none. */
const blob_t *dictionary_word(void);

#endif
