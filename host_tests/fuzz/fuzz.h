/*
 * What the fuzz targets share. A target is one source with LLVMFuzzerTestOneInput, as libFuzzer calls it; with gcc the
 * same source is driven by fuzz_drive.c. A broken property ends the process by fuzz_fail; campaigns/fuzz/fuzz.py keeps
 * the input.
 */
#ifndef FUZZ_H
#define FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* The program under test as after a reset of the chip: all its variables as the start-up code sets them. */
void fuzz_reset_memory(void);

/* Says what is wrong and aborts. */
_Noreturn void fuzz_fail(const char *file, int line, const char *format, ...) __attribute__((format(printf, 3, 4)));

#define FUZZ_CHECK(condition, ...)                      \
    do {                                                \
        if (!(condition)) {                             \
            fuzz_fail(__FILE__, __LINE__, __VA_ARGS__); \
        }                                               \
    } while (0)

/* Reads numbers off the input, little endian; zeros once it is used up. */
typedef struct {
    const uint8_t *data;
    size_t size;
    size_t at;
} fuzz_input_t;

static inline bool fuzz_more(const fuzz_input_t *in)
{
    return in->at < in->size;
}

static inline uint8_t fuzz_u8(fuzz_input_t *in)
{
    return fuzz_more(in) ? in->data[in->at++] : 0;
}

static inline uint16_t fuzz_u16(fuzz_input_t *in)
{
    uint16_t low = fuzz_u8(in);
    return (uint16_t)(low | (uint16_t)(fuzz_u8(in) << 8));
}

static inline uint32_t fuzz_u32(fuzz_input_t *in)
{
    uint32_t low = fuzz_u16(in);
    return low | ((uint32_t)fuzz_u16(in) << 16);
}

#endif
