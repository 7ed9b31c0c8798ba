/*
 * By call chain: a cell is an instruction in a frame. A frame is identified by the cell of the call that opened it, or
 * of the vector where an interrupt enters; frame 0 has no caller. So one table holds the whole tree. A jump opens no
 * frame: a function that ends by jumping into another, or into the compiler's shared prologues and epilogues, stays in
 * the frame of the function that was called.
 */
#include "simrun_profile.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
static uint8_t straight_cycles[FLASH_WORDS]; /* of what always goes on to the next instruction and has run; else 0 */

/* From an instruction to the next after which the program may go elsewhere; only its last one may vary in cycles. */
typedef struct {
    uint8_t cycles, before_last; /* 0 cycles: not all of its instructions have run yet */
    uint64_t count, last_cycles;
} straight_t;

static straight_t straight[FLASH_WORDS];
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

void profile_start(const char *path, const char *calls)
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
}

bool profile_wanted(void)
{
    return profile_path != NULL || calls_path != NULL;
}

/* Branches, skips, jumps, calls, returns, and what sets a flag of the status register, sleeps or writes the flash. */
static bool may_go_elsewhere(unsigned opcode)
{
    bool branch_or_skip = opcode >= 0xF000 && (opcode & 0xFC00) != 0xF800; /* the rest is BLD and BST */
    bool relative = (opcode & 0xE000) == 0xC000;
    bool compare_and_skip = (opcode & 0xFC00) == 0x1000;
    bool skip_by_port = (opcode & 0xFD00) == 0x9900;
    bool various = (opcode & 0xFE08) == 0x9408 && (opcode & 0xF) != 0xA; /* DEC */
    return branch_or_skip || relative || compare_and_skip || skip_by_port || various;
}

static uint32_t following(uint32_t pc)
{
    bool two_words = (mcu_opcode_at(pc) & 0xFC0F) == 0x9000; /* LDS, STS */
    return pc + (two_words ? 4 : 2);
}

static uint8_t *straight_at(uint32_t pc)
{
    return &straight_cycles[pc / 2 % FLASH_WORDS];
}

static void measure(straight_t *run, uint32_t pc, uint64_t most)
{
    unsigned cycles = 0, last = 0;
    while (cycles < most && *straight_at(pc) != 0) {
        last = *straight_at(pc);
        cycles += last;
        pc = following(pc);
    }
    if (cycles >= most) {
        *run = (straight_t){ .cycles = (uint8_t)cycles, .before_last = (uint8_t)(cycles - last) };
    } else if (may_go_elsewhere(mcu_opcode_at(pc))) {
        *run = (straight_t){ .cycles = (uint8_t)(cycles + 1), .before_last = (uint8_t)cycles };
    }
}

uint64_t profile_straight_cycles(uint32_t pc, uint64_t most)
{
    straight_t *run = &straight[pc / 2 % FLASH_WORDS];
    if (run->cycles == 0) {
        measure(run, pc, most);
    }
    return run->cycles;
}

/* The response to an interrupt is charged to the vector, not to the instruction, or the sleep, after which it came. */
static void note(uint32_t pc, uint64_t count, uint64_t cycles)
{
    bool interrupt = pc != 0 && pc / VECTOR_BYTES < VECTORS;
    cycles += interrupt ? count * ENTRY_CYCLES : 0u;
    if (profile != NULL) {
        uint32_t word = pc / 2 % FLASH_WORDS;
        profile[word].count += count;
        profile[word].cycles += cycles;
    }
    if (calls_path != NULL) {
        note_call(pc, cycles, interrupt);
    }
}

/* Notes instructions from there on, the last with the cycles that are left. */
static void note_straight(uint32_t pc, uint64_t count, uint64_t cycles)
{
    while (*straight_at(pc) != 0 && cycles > count * *straight_at(pc)) {
        note(pc, count, count * *straight_at(pc));
        cycles -= count * *straight_at(pc);
        pc = following(pc);
    }
    note(pc, count, cycles);
}

void profile_on_step(uint32_t pc, uint64_t cycles)
{
    enum { STRAIGHT_MAX = 3 };
    straight_t *run = &straight[pc / 2 % FLASH_WORDS];
    if (calls_path == NULL && run->cycles != 0 && cycles > run->before_last) {
        run->count++;
        run->last_cycles += cycles - run->before_last;
        return;
    }
    if (*straight_at(pc) == 0 && cycles <= STRAIGHT_MAX && !may_go_elsewhere(mcu_opcode_at(pc))) {
        *straight_at(pc) = (uint8_t)cycles;
    }
    note_straight(pc, 1, cycles);
}

static void note_all(void)
{
    for (uint32_t word = 0; word < FLASH_WORDS; word++) {
        const straight_t *run = &straight[word];
        if (run->count != 0) {
            note_straight(word * 2, run->count, run->count * run->before_last + run->last_cycles);
        }
    }
}

/* A boot loader may have written other instructions. */
void profile_reset(void)
{
    depth = 0;
    note_all();
    memset(straight, 0, sizeof straight);
    memset(straight_cycles, 0, sizeof straight_cycles);
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
        note_all();
        write_profile();
    }
    if (calls_path != NULL) {
        write_calls();
    }
}
