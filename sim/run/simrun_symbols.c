#include "simrun_symbols.h"

#include <fcntl.h>
#include <gelf.h>
#include <libelf.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "simrun_output.h"

enum { RAM_OFFSET = 0x800000, EEPROM_OFFSET = 0x810000, EM_AVR_MACHINE = 83, UNO_MHZ = 16 };

typedef struct {
    uint32_t pc;
    char *name;
} symbol_t;

typedef struct {
    symbol_t *list;
    size_t count;
} symbols_t;

static symbols_t functions; /* pc: byte address in flash */
static symbols_t variables; /* pc: address in data space */

static void add_symbol(symbols_t *symbols, uint32_t pc, const char *name)
{
    symbol_t *grown = realloc(symbols->list, (symbols->count + 1) * sizeof *grown);
    char *copy = strdup(name);
    if (grown == NULL || copy == NULL) {
        output_refuse("%s: out of memory", name);
    }
    symbols->list = grown;
    symbols->list[symbols->count].pc = pc;
    symbols->list[symbols->count].name = copy;
    symbols->count++;
}

static bool is_function(const GElf_Sym *symbol)
{
    unsigned type = GELF_ST_TYPE(symbol->st_info);
    bool in_flash = symbol->st_value < RAM_OFFSET && symbol->st_shndx != SHN_ABS && symbol->st_shndx != SHN_UNDEF;
    return in_flash && (type == STT_FUNC || type == STT_NOTYPE);
}

static bool is_variable(const GElf_Sym *symbol)
{
    return GELF_ST_TYPE(symbol->st_info) == STT_OBJECT && symbol->st_value >= RAM_OFFSET &&
           symbol->st_value < EEPROM_OFFSET;
}

static void take_symbol(const GElf_Sym *symbol, const char *name, program_size_t *size)
{
    if (strcmp(name, "_end") == 0) {
        size->end_of_ram = (uint32_t)symbol->st_value & 0xFFFFu;
    } else if (strcmp(name, "cpu_hz") == 0) {
        size->cycles_per_us = (uint32_t)(symbol->st_value / 1000000u);
    } else if (is_function(symbol)) {
        add_symbol(&functions, (uint32_t)symbol->st_value, name);
    } else if (is_variable(symbol)) {
        add_symbol(&variables, (uint32_t)symbol->st_value & 0xFFFFu, name);
    }
}

static void take_symbols(Elf *elf, Elf_Scn *section, const GElf_Shdr *header, program_size_t *size)
{
    Elf_Data *data = elf_getdata(section, NULL);
    size_t count = header->sh_entsize == 0 ? 0 : header->sh_size / header->sh_entsize;
    for (size_t i = 0; data != NULL && i < count; i++) {
        GElf_Sym symbol;
        if (gelf_getsym(data, (int)i, &symbol) == NULL) {
            continue;
        }
        const char *name = elf_strptr(elf, header->sh_link, symbol.st_name);
        if (name != NULL && *name != '\0') {
            take_symbol(&symbol, name, size);
        }
    }
}

static void take_sizes(const GElf_Shdr *header, program_size_t *size)
{
    if (header->sh_type != SHT_PROGBITS || !(header->sh_flags & SHF_ALLOC) || header->sh_addr >= EEPROM_OFFSET) {
        return;
    }
    size->flash_bytes += (uint32_t)header->sh_size;
    if (header->sh_addr < RAM_OFFSET) {
        size->code_bytes += (uint32_t)header->sh_size;
    }
}

static int compare(const void *a, const void *b)
{
    const symbol_t *x = a;
    const symbol_t *y = b;
    if (x->pc != y->pc) {
        return x->pc < y->pc ? -1 : 1;
    }
    return strcmp(x->name, y->name);
}

static void sort(const symbols_t *symbols)
{
    if (symbols->count != 0) {
        qsort(symbols->list, symbols->count, sizeof *symbols->list, compare);
    }
}

static Elf *open_elf(const char *path, int file)
{
    elf_version(EV_CURRENT);
    Elf *elf = elf_begin(file, ELF_C_READ, NULL);
    GElf_Ehdr header;
    if (elf == NULL || elf_kind(elf) != ELF_K_ELF || gelf_getehdr(elf, &header) == NULL) {
        output_refuse("%s: not an ELF file", path);
    }
    if (header.e_machine != EM_AVR_MACHINE) {
        output_refuse("%s: an ELF file, but not for an AVR", path);
    }
    return elf;
}

void symbols_load(const char *path, program_size_t *size)
{
    *size = (program_size_t){ .cycles_per_us = UNO_MHZ };
    int file = open(path, O_RDONLY);
    if (file < 0) {
        output_refuse("%s: cannot open", path);
    }
    Elf *elf = open_elf(path, file);
    Elf_Scn *section = NULL;
    while ((section = elf_nextscn(elf, section)) != NULL) {
        GElf_Shdr header;
        if (gelf_getshdr(section, &header) == NULL) {
            continue;
        }
        take_sizes(&header, size);
        if (header.sh_type == SHT_SYMTAB) {
            take_symbols(elf, section, &header, size);
        }
    }
    elf_end(elf);
    close(file);
    if (size->code_bytes == 0) {
        output_refuse("%s: no program in it", path);
    }
    if (size->cycles_per_us == 0 || size->cycles_per_us > UNO_MHZ) {
        output_refuse("%s: its symbol cpu_hz, the processor's clock, is not between 1 and 16 MHz", path);
    }
    sort(&functions);
    sort(&variables);
}

/* The exact name wins; otherwise the first one with a compiler suffix after it. */
static bool find(const symbols_t *symbols, const char *name, uint32_t *value)
{
    size_t length = strlen(name);
    bool found = false;
    for (size_t i = 0; i < symbols->count; i++) {
        const char *other = symbols->list[i].name;
        if (strcmp(other, name) == 0) {
            *value = symbols->list[i].pc;
            return true;
        }
        if (!found && strncmp(other, name, length) == 0 && other[length] == '.') {
            *value = symbols->list[i].pc;
            found = true;
        }
    }
    return found;
}

bool symbols_find(const char *name, uint32_t *pc)
{
    return find(&functions, name, pc);
}

bool symbols_find_variable(const char *name, uint32_t *address)
{
    return find(&variables, name, address);
}

static const char *nearest(const symbols_t *symbols, uint32_t value)
{
    static char text[128];
    const symbol_t *best = NULL;
    for (size_t i = 0; i < symbols->count && symbols->list[i].pc <= value; i++) {
        best = &symbols->list[i];
    }
    if (best == NULL) {
        return "?";
    }
    snprintf(text, sizeof text, "%.100s+0x%x", best->name, (unsigned)(value - best->pc));
    return text;
}

const char *symbols_nearest(uint32_t pc)
{
    return nearest(&functions, pc);
}

const char *symbols_variable_at(uint32_t address)
{
    return nearest(&variables, address);
}
