/*
 * Failures, and the memory of the program under test. The build puts all its variables into the sections fuzz_data and
 * fuzz_bss (campaigns/fuzz/fuzz.mk), so that every input starts from the same state without a new process.
 */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "fuzz.h"

extern uint8_t __start_fuzz_data[], __stop_fuzz_data[], __start_fuzz_bss[], __stop_fuzz_bss[];

static uint8_t *kept_data;
static uint8_t *kept_bss;

void fuzz_fail(const char *file, int line, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "%s:%d: ", file, line);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    abort();
}

/* Byte by byte, volatile, and unwatched: the red zones between the variables are copied too. */
__attribute__((no_sanitize("address"))) static void copy(volatile uint8_t *to, const volatile uint8_t *from,
                                                         size_t size)
{
    volatile uint64_t *wide_to = (volatile uint64_t *)(volatile void *)to;
    const volatile uint64_t *wide_from = (const volatile uint64_t *)(const volatile void *)from;
    for (size_t i = 0; i < size / 8; i++) {
        wide_to[i] = wide_from[i];
    }
    for (size_t i = size & ~(size_t)7; i < size; i++) {
        to[i] = from[i];
    }
}

static uint8_t *keep(const uint8_t *from, size_t size)
{
    uint8_t *kept = malloc(size + 1);
    FUZZ_CHECK(kept != NULL, "out of memory");
    copy(kept, from, size);
    return kept;
}

void fuzz_reset_memory(void)
{
    size_t data_size = (size_t)(__stop_fuzz_data - __start_fuzz_data);
    size_t bss_size = (size_t)(__stop_fuzz_bss - __start_fuzz_bss);
    if (kept_data == NULL) {
        kept_data = keep(__start_fuzz_data, data_size);
        kept_bss = keep(__start_fuzz_bss, bss_size);
        return;
    }
    copy(__start_fuzz_data, kept_data, data_size);
    copy(__start_fuzz_bss, kept_bss, bss_size);
}
