/*
 * By call chain: a cell is an instruction in a frame. A frame is identified by the cell of the call that opened it, or
 * of the vector where an interrupt enters; frame 0 has no caller. So one table holds the whole tree. A jump opens no
 * frame: a function that ends by jumping into another, or into the compiler's shared prologues and epilogues, stays in
 * the frame of the function that was called.
 */
#include "simrun_profile.h"

#include <stdio.h>
#include <stdlib.h>

#include "simrun_mcu.h"
#include "simrun_output.h"
#include "simrun_symbols.h"
#include "simrun_times.h"

enum {
    CELLS = 1 << 17,
    PLACES = 2 * CELLS, /* of the hash table */
    DEPTH = 64
};

typedef struct {
    uint32_t frame, pc;
    uint64_t count, cycles;
} cell_t;

static const char *profile_path, *calls_path;
static struct {
    uint64_t count, cycles;
} * profile;
static cell_t cells[CELLS]; /* in the order of their first use, so that a longer run only appends; 0 means none */
static uint32_t places[PLACES];
static uint32_t used = 1;
static uint32_t frames[DEPTH]; /* open frames, the newest last */
static unsigned depth;

static void give_up(const char *what)
{
    fprintf(stderr, "simrun: --calls: %s\n", what);
    exit(EXIT_INTERNAL);
}

static uint32_t cell_of(uint32_t frame, uint32_t pc)
{
    uint32_t place = (frame * UINT32_C(2654435761) ^ pc * UINT32_C(40503)) % PLACES;
    for (; places[place] != 0; place = (place + 1) % PLACES) {
        const cell_t *cell = &cells[places[place]];
        if (cell->frame == frame && cell->pc == pc) {
            return places[place];
        }
    }
    if (used == CELLS) {
        give_up("too many chains of callers");
    }
    cells[used] = (cell_t){ frame, pc, 0, 0 };
    places[place] = used;
    return used++;
}

static void open_frame(uint32_t cell)
{
    if (depth == DEPTH) {
        give_up("calls are nested too deep");
    }
    frames[depth++] = cell;
}

static bool is_call(unsigned opcode)
{
    enum { CALL = 0x940E, CALL_MASK = 0xFE0E, RCALL = 0xD000, RCALL_MASK = 0xF000, ICALL = 0x9509 };
    bool makes_room = opcode == RCALL; /* RCALL to the next instruction: reserves two bytes on the stack, no function */
    return (opcode & CALL_MASK) == CALL || ((opcode & RCALL_MASK) == RCALL && !makes_room) || opcode == ICALL;
}

static void note_call(uint32_t pc, uint64_t cycles, bool interrupt)
{
    enum { RET = 0x9508, RETI = 0x9518 };
    uint32_t cell = cell_of(interrupt || depth == 0 ? 0 : frames[depth - 1], pc);
    cells[cell].count++;
    cells[cell].cycles += cycles;
    unsigned opcode = mcu_opcode_at(pc);
    if (interrupt || is_call(opcode)) {
        open_frame(cell);
    }
    if ((opcode == RET || opcode == RETI) && depth != 0) {
        depth--;
    }
}

void profile_reset(void)
{
    depth = 0;
}

static void write_calls(void)
{
    FILE *file = output_open(calls_path);
    fputs("cell,frame,pc,count,cycles,symbol\n", file);
    for (uint32_t i = 1; i < used; i++) {
        fprintf(file, "%u,%u,0x%04x,%llu,%llu,%s\n", (unsigned)i, (unsigned)cells[i].frame, (unsigned)cells[i].pc,
                (unsigned long long)cells[i].count, (unsigned long long)cells[i].cycles, symbols_nearest(cells[i].pc));
    }
    output_close(file, calls_path);
}

bool profile_start(const char *path, const char *calls)
{
    profile_path = path;
    calls_path = calls;
    if (path != NULL) {
        profile = calloc(FLASH_WORDS, sizeof *profile);
        if (profile == NULL) {
            fputs("simrun: out of memory\n", stderr);
            exit(EXIT_INTERNAL);
        }
    }
    return path != NULL || calls != NULL;
}

/* The response to an interrupt is charged to the vector, not to the instruction, or the sleep, after which it came. */
void profile_on_step(uint32_t pc, uint64_t cycles)
{
    bool interrupt = pc != 0 && pc / VECTOR_BYTES < VECTORS;
    cycles += interrupt ? ENTRY_CYCLES : 0u;
    if (profile != NULL) {
        uint32_t word = pc / 2 % FLASH_WORDS;
        profile[word].count++;
        profile[word].cycles += cycles;
    }
    if (calls_path != NULL) {
        note_call(pc, cycles, interrupt);
    }
}

static void write_profile(void)
{
    FILE *file = output_open(profile_path);
    fputs("pc,count,cycles,symbol\n", file);
    for (uint32_t word = 0; word < FLASH_WORDS; word++) {
        if (profile[word].count != 0) {
            fprintf(file, "0x%04x,%llu,%llu,%s\n", (unsigned)word * 2, (unsigned long long)profile[word].count,
                    (unsigned long long)profile[word].cycles, symbols_nearest(word * 2));
        }
    }
    output_close(file, profile_path);
    free(profile);
}

void profile_finish(void)
{
    if (profile_path != NULL) {
        write_profile();
    }
    if (calls_path != NULL) {
        write_calls();
    }
}
