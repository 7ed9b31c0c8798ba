/*
 * The boot loader's image, Intel HEX, beside the firmware. simavr 1.6 has its own reader, which takes the start address
 * record of Arduino's images for data.
 */
#include <ctype.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "simrun.h"

enum {
    FLASH_BYTES = 0x8000,
    BOOT_MIN = 0x7000, /* the largest boot section of this chip */
    RECORD_MAX = 255 + 5
};

/* Record types; the start addresses (03, 05) are for CPUs with segments and have no meaning here. */
enum { TYPE_DATA, TYPE_END, TYPE_SEGMENT, TYPE_SEGMENT_START, TYPE_LINEAR, TYPE_LINEAR_START };

typedef struct {
    unsigned line;
    uint32_t base;  /* from the records 02 and 04 */
    uint32_t start; /* lowest address so far */
    bool ended;
} reader_t;

static void refuse(unsigned line, const char *format, ...) __attribute__((format(printf, 2, 3), noreturn));
static void refuse(unsigned line, const char *format, ...)
{
    va_list arguments;
    fprintf(stderr, "simrun: %s", options.bootloader);
    if (line != 0) {
        fprintf(stderr, ":%u", line);
    }
    fputs(": ", stderr);
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
    exit(EXIT_INPUT);
}

/*
 * Decodes the bytes of a line, ":" and hexadecimal digits, and checks them as a record; returns the number of data
 * bytes after the header.
 */
static unsigned decode(const char *text, unsigned line, uint8_t record[RECORD_MAX])
{
    size_t count = 0;
    uint8_t sum = 0;
    const char *at = text + 1;
    for (; isxdigit((unsigned char)at[0]) && isxdigit((unsigned char)at[1]) && count < RECORD_MAX; at += 2) {
        const char pair[3] = { at[0], at[1], '\0' };
        record[count] = (uint8_t)strtoul(pair, NULL, 16);
        sum = (uint8_t)(sum + record[count]);
        count++;
    }
    if (text[0] != ':' || strspn(at, "\r\n") != strlen(at)) {
        refuse(line, "not a record of an Intel HEX image");
    }
    if (count < 5 || count != record[0] + 5u || sum != 0) {
        refuse(line, "a record cut short or with a wrong checksum");
    }
    return record[0];
}

static void take_data(reader_t *reader, uint32_t address, const uint8_t *data, unsigned count)
{
    if (address < BOOT_MIN || address + count > FLASH_BYTES) {
        refuse(reader->line, "not within the boot section 0x7000..0x7FFF");
    }
    memcpy(mcu->flash + address, data, count);
    reader->start = address < reader->start ? address : reader->start;
}

static void take_record(reader_t *reader, const uint8_t *record, unsigned count)
{
    const uint8_t *data = record + 4;
    uint32_t word = count < 2 ? 0 : (uint32_t)data[0] << 8 | data[1];
    switch (record[3]) {
    case TYPE_DATA:
        take_data(reader, reader->base + ((uint32_t)record[1] << 8 | record[2]), data, count);
        break;
    case TYPE_END:
        reader->ended = true;
        break;
    case TYPE_SEGMENT:
        reader->base = word << 4;
        break;
    case TYPE_LINEAR:
        reader->base = word << 16;
        break;
    case TYPE_SEGMENT_START:
    case TYPE_LINEAR_START:
        break;
    default:
        refuse(reader->line, "an unknown record type %02x", (unsigned)record[3]);
    }
}

uint32_t bootloader_load(void)
{
    FILE *file = fopen(options.bootloader, "r");
    if (file == NULL) {
        refuse(0, "cannot open");
    }
    reader_t reader = { .start = FLASH_BYTES };
    char text[2 * RECORD_MAX + 8];
    while (!reader.ended && fgets(text, sizeof text, file) != NULL) {
        uint8_t record[RECORD_MAX] = { 0 };
        reader.line++;
        unsigned count = decode(text, reader.line, record);
        take_record(&reader, record, count);
    }
    fclose(file);
    if (!reader.ended || reader.start == FLASH_BYTES) {
        refuse(0, "an Intel HEX image without %s", reader.ended ? "data" : "an end record");
    }
    return reader.start;
}
