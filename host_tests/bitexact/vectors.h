/*
 * The vector program: paths of the arithmetic, each a sequence of items; what an item answers goes into a CRC-32 per
 * block, or, in the block asked for, is printed with its input and the state behind it. One source for all builds.
 */
#ifndef VECTORS_H
#define VECTORS_H

#include <stdint.h>

#include "filter_list.h"

#define VECTORS_BLOCK 200U

/* What an item tells about itself. Inputs and states are for the reader of a difference, outputs are compared. */
void vectors_input(uint32_t value);
void vectors_output(uint32_t value, uint8_t bytes);
void vectors_state(const void *bytes, uint8_t size);

/* Random numbers of the path, anew at its start. */
uint32_t vectors_random(void);

/* --- the paths: number of them, name of each (program memory), items, what to do before the first and for each --- */
typedef struct {
    const char *name;
    uint16_t items;
} vectors_path_t;

uint8_t filter_paths(void);
vectors_path_t filter_path(uint8_t which);
void filter_path_item(uint8_t which, uint16_t index);

uint8_t primitive_paths(void);
vectors_path_t primitive_path(uint8_t which);
void primitive_path_item(uint8_t which, uint16_t index);

uint8_t other_paths(void);
vectors_path_t other_path(uint8_t which);
void other_path_item(uint8_t which, uint16_t index);

uint8_t text_paths(void);
vectors_path_t text_path(uint8_t which);
void text_path_item(uint8_t which, uint16_t index);

#endif
