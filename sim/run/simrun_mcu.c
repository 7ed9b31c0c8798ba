#include "simrun_mcu.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "avr_extint.h"
#include "avr_ioport.h"
#include "sim_elf.h"
#include "simrun_output.h"

enum {
    PIN_STRAP = 4,     /* of port D */
    BOOT_MIN = 0x7000, /* the largest boot section of this chip */
    RECORD_MAX = 255 + 5
};

avr_t *mcu;
program_size_t mcu_program;
static uint32_t boot_start = FLASH_BYTES;
static uint32_t random_state;

double mcu_ms(void)
{
    return (double)mcu->cycle / CYCLES_PER_MS;
}

bool mcu_in_boot_loader(uint32_t pc)
{
    return pc >= boot_start && pc < FLASH_BYTES;
}

uint32_t mcu_random(void)
{
    random_state ^= random_state << 13;
    random_state ^= random_state >> 17;
    random_state ^= random_state << 5;
    return random_state;
}

uint16_t mcu_stack_pointer(void)
{
    enum { REG_SPL = 0x5D };
    return (uint16_t)(mcu->data[REG_SPL] | mcu->data[REG_SPL + 1] << 8);
}

unsigned mcu_opcode_at(uint32_t pc)
{
    return mcu->flash[pc] | (unsigned)mcu->flash[pc + 1] << 8;
}

/*
 * The boot loader's image, Intel HEX, beside the firmware. simavr 1.6 has its own reader, which takes the start address
 * record of Arduino's images for data.
 */

/* Record types; the start addresses (03, 05) are for CPUs with segments and have no meaning here. */
enum { TYPE_DATA, TYPE_END, TYPE_SEGMENT, TYPE_SEGMENT_START, TYPE_LINEAR, TYPE_LINEAR_START };

typedef struct {
    unsigned line;
    uint32_t base;  /* from the records 02 and 04 */
    uint32_t start; /* lowest address so far */
    bool ended;
} reader_t;

static const char *image;

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
        output_refuse("%s:%u: not a record of an Intel HEX image", image, line);
    }
    if (count < 5 || count != record[0] + 5u || sum != 0) {
        output_refuse("%s:%u: a record cut short or with a wrong checksum", image, line);
    }
    return record[0];
}

static void take_data(reader_t *reader, uint32_t address, const uint8_t *data, unsigned count)
{
    if (address < BOOT_MIN || address + count > FLASH_BYTES) {
        output_refuse("%s:%u: not within the boot section 0x7000..0x7FFF", image, reader->line);
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
        output_refuse("%s:%u: an unknown record type %02x", image, reader->line, (unsigned)record[3]);
    }
}

static uint32_t load_image(const char *path)
{
    image = path;
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        output_refuse("%s: cannot open", path);
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
        output_refuse("%s: an Intel HEX image without %s", path, reader.ended ? "data" : "an end record");
    }
    return reader.start;
}

/* Starts in the boot loader as after the reset that an UNO gets when its port is opened. */
static void load_boot_loader(const mcu_options_t *wanted)
{
    if (wanted->blank) {
        memset(mcu->flash, 0xFF, FLASH_BYTES);
    }
    boot_start = load_image(wanted->bootloader);
    mcu->codeend = FLASH_BYTES;
    mcu->reset_pc = boot_start;
    mcu->pc = boot_start;
    avr_regbit_clear(mcu, mcu->reset_flags.porf);
    avr_regbit_set(mcu, mcu->reset_flags.extrf);
}

static void load_program(const char *path)
{
    elf_firmware_t program;
    memset(&program, 0, sizeof program);
    symbols_load(path, &mcu_program);
    if (elf_read_firmware(path, &program) != 0) {
        output_refuse("%s: not a firmware that simavr can load", path);
    }
    if (mcu_program.flash_bytes > FLASH_BYTES) {
        output_refuse("%s: larger than the flash", path);
    }
    mcu = avr_make_mcu_by_name("atmega328p");
    if (mcu == NULL || avr_init(mcu) != 0) {
        output_refuse("libsimavr: no ATmega328P in it");
    }
    snprintf(program.mmcu, sizeof program.mmcu, "atmega328p");
    program.frequency = CYCLES_PER_MS * 1000u;
    mcu->frequency = program.frequency;
    avr_load_firmware(mcu, &program);
    mcu->codeend = program.flashsize;
    mcu->log = LOG_WARNING;
    free(program.flash);
}

/*
 * simavr 1.6 takes up a pin that is low before the program has chosen an edge as a level: it would go on to raise the
 * interrupt in each cycle until the pin is high.
 */
void mcu_poll_no_levels(void)
{
    avr_extint_set_strict_lvl_trig(mcu, 0, 0);
    avr_extint_set_strict_lvl_trig(mcu, 1, 0);
}

void mcu_start(const mcu_options_t *wanted)
{
    random_state = wanted->seed * 2654435769u; /* a small seed gives small numbers at first, below every probability */
    load_program(wanted->fw);
    mcu_poll_no_levels();
    if (wanted->bootloader != NULL) {
        load_boot_loader(wanted);
    }
    if (wanted->strap) {
        avr_ioport_external_t ground = { .name = 'D', .mask = 1u << PIN_STRAP, .value = 0 };
        avr_ioctl(mcu, AVR_IOCTL_IOPORT_SET_EXTERNAL('D'), &ground);
    }
}

/* A pull-up would not be a change to the line. */
void mcu_forget_strap(void)
{
    avr_io_getirq(mcu, AVR_IOCTL_IOPORT_GETIRQ('D'), PIN_STRAP)->value = 0;
}
