/*
 * Data that main and a handler share, with at least one of them writing, is found as the program runs. Before each
 * instruction of main that touches such a byte, and before the one after it, main is made to wait until the interrupt
 * comes, if it would come within REACH cycles. To the program that is a longer path to that place, or one more
 * interrupt on the way; no part of the chip does anything that it would not have done.
 *
 * A pair is such an instruction with such a vector. It is taken "before" if that interrupt is served before the
 * instruction, whatever caused it, and "after" if it is served after it: between a read and its consequences. A pair
 * whose instruction ran only with interrupts off is guarded.
 */
#include "simrun_race.h"

#include <stdio.h>

#include "sim_interrupts.h"
#include "simrun_access.h"
#include "simrun_faults.h"
#include "simrun_mcu.h"
#include "simrun_output.h"
#include "simrun_resets.h"
#include "simrun_sensor.h"
#include "simrun_symbols.h"
#include "simrun_times.h"
#include "simrun_uart.h"

enum {
    REACH = 200, /* most cycles that main waits, */
    CHAIN = 4,   /* and for a timer that the awaited one sets: the transmitter's buffer is empty 2 cycles later */
    DOUBT = 8,   /* a timer that raised its interrupt less than once in this many waits is not waited for */
    TAKEN_A_MINUTE = 4,  /* how often a pair is forced, each way, per minute of simulated time */
    TIMER1_FIRST = 0x84, /* TCNT1L */
    TIMER1_LAST = 0x8B,  /* OCR1BH */
    CELLS = 0x901,
    TOUCHED_MAX = 6, /* addresses remembered for an instruction whose address varies */
    KINDS_MAX = 64
};

enum { BEFORE, AFTER, SIDES };

/* An instruction of main. */
typedef struct {
    access_t touched[TOUCHED_MAX];
    uint8_t touched_count;
    bool open;        /* it has run with interrupts on */
    uint32_t vectors; /* whose handlers share something with it */
    uint16_t taken[SIDES][VECTORS];
} place_t;

/* What a timer of the simulator is used for, and how often it raised each vector, or was waited for because of it. */
typedef struct {
    avr_cycle_timer_t timer;
    void *param;
    unsigned due; /* which of simrun's own parts it will step */
    unsigned raised[VECTORS], awaited[VECTORS];
} kind_t;

static FILE *file;
static const char *file_path;
static place_t places[FLASH_WORDS];
static uint32_t handler_reads[CELLS], handler_writes[CELLS]; /* by vector */
static avr_int_vector_t *vectors[VECTORS];
static kind_t kinds[KINDS_MAX];
static size_t kind_count;
static struct {
    kind_t *kind;
    uint64_t at;
} next = { NULL, NEVER }, newest = { NULL, NEVER }; /* timer: the next one due, the last one that fired */
static uint32_t served;                             /* since main's last instruction */
static unsigned running;                            /* the vector whose handler runs */
static place_t *last;                               /* main's last instruction */
static uint64_t waits, waited_cycles;
static struct {
    unsigned taken, guarded, not_reached;
} count;

static place_t *place_at(uint32_t pc)
{
    return &places[pc / 2 % FLASH_WORDS];
}

/* One timer of the machine steps several parts; only the part that is due shows which interrupt may follow. */
static unsigned due_at(uint64_t at)
{
    return (sensor_next() <= at ? 1u : 0u) | (uart_next() <= at ? 2u : 0u) | (faults_next() <= at ? 4u : 0u);
}

static kind_t *kind_of(const avr_cycle_timer_slot_t *slot)
{
    unsigned due = due_at(slot->when);
    for (size_t i = 0; i < kind_count; i++) {
        if (kinds[i].timer == slot->timer && kinds[i].param == slot->param && kinds[i].due == due) {
            return &kinds[i];
        }
    }
    if (kind_count == KINDS_MAX) {
        return NULL;
    }
    kinds[kind_count] = (kind_t){ .timer = slot->timer, .param = slot->param, .due = due };
    return &kinds[kind_count++];
}

static void note_next_timer(void)
{
    const avr_cycle_timer_slot_t *first = mcu->cycle_timers.timer;
    if (next.at <= mcu->cycle) {
        newest = next;
    }
    next.kind = first == NULL ? NULL : kind_of(first);
    next.at = first == NULL ? NEVER : first->when;
}

/* Learns what each timer raises, or the one it sets; if two are due at once the first counts for both. */
static void on_pending(avr_irq_t *irq, uint32_t value, void *param)
{
    (void)irq;
    const avr_int_vector_t *vector = param;
    if (value && next.kind != NULL && mcu->cycle >= next.at) {
        next.kind->raised[vector->vector]++;
        if (newest.kind != NULL && newest.kind != next.kind && mcu->cycle <= newest.at + CHAIN) {
            newest.kind->raised[vector->vector]++;
        }
    }
}

bool race_start(const char *path)
{
    if (path == NULL) {
        return false;
    }
    file_path = path;
    file = output_open(path);
    for (int i = 0; i < mcu->interrupts.vector_count; i++) {
        avr_int_vector_t *vector = mcu->interrupts.vector[i];
        if (vector->vector != 0 && vector->vector < VECTORS) {
            vectors[vector->vector] = vector;
            avr_irq_register_notify(&vector->irq[AVR_INT_IRQ_PENDING], on_pending, vector);
        }
    }
    return true;
}

/* Core registers are private to each context, and so is the stack. */
static bool may_be_shared(uint16_t address)
{
    enum { REG_GENERAL_LAST = 0x1F, REG_SPL = 0x5D, REG_SREG = 0x5F };
    bool core = address <= REG_GENERAL_LAST || (address >= REG_SPL && address <= REG_SREG);
    return !core && (address < RAM_START || address < mcu_program.end_of_ram);
}

static bool through_temp(uint16_t address)
{
    return address >= TIMER1_FIRST && address <= TIMER1_LAST;
}

static void note_in_handler(uint32_t pc)
{
    access_t access = access_at(pc);
    if (!may_be_shared(access.address)) {
        return;
    }
    handler_reads[access.address] |= access.reads ? 1u << running : 0u;
    handler_writes[access.address] |= access.writes ? 1u << running : 0u;
    if (through_temp(access.address)) {
        handler_writes[TIMER1_TEMP] |= 1u << running;
    }
}

static uint32_t sharers(uint16_t address, bool reads, bool writes)
{
    return (reads || writes ? handler_writes[address] : 0u) | (writes ? handler_reads[address] : 0u);
}

static void touch(place_t *place, uint16_t address, bool reads, bool writes)
{
    place->vectors |= sharers(address, reads, writes);
    for (unsigned i = 0; i < place->touched_count; i++) {
        if (place->touched[i].address == address) {
            return;
        }
    }
    if (place->touched_count < TOUCHED_MAX) {
        place->touched[place->touched_count++] = (access_t){ address, reads, writes };
    }
}

static void note_in_main(place_t *place, uint32_t pc)
{
    access_t access = access_at(pc);
    if (may_be_shared(access.address)) {
        touch(place, access.address, access.reads, access.writes);
        if (through_temp(access.address)) {
            touch(place, TIMER1_TEMP, false, true);
        }
        place->open = place->open || mcu->sreg[S_I] != 0;
    }
}

static void mark(place_t *place, unsigned side)
{
    for (unsigned v = 1; place != NULL && v < VECTORS; v++) {
        if ((served >> v & 1u) != 0 && place->taken[side][v] < UINT16_MAX) {
            place->taken[side][v]++;
        }
    }
}

/* Its vectors that have not come often enough there, and are enabled. */
static uint32_t lacking(const place_t *place, unsigned side)
{
    unsigned enough = TAKEN_A_MINUTE * (1u + (unsigned)(mcu_ms() / 60e3));
    uint32_t found = 0;
    for (unsigned v = 1; place != NULL && place->vectors >> v != 0; v++) {
        bool wanted = (place->vectors >> v & 1u) != 0 && place->taken[side][v] < enough;
        if (wanted && vectors[v] != NULL && avr_regbit_get(mcu, vectors[v]->enable)) {
            found |= 1u << v;
        }
    }
    return found;
}

static bool promises(kind_t *kind, uint32_t wanted)
{
    bool any = false;
    for (unsigned v = 1; kind != NULL && v < VECTORS; v++) {
        if ((wanted >> v & 1u) != 0 && kind->raised[v] != 0 && kind->awaited[v] / DOUBT <= kind->raised[v]) {
            kind->awaited[v]++;
            any = true;
        }
    }
    return any;
}

/* When one of these vectors is expected; NEVER if that is out of reach. */
static uint64_t expected(uint32_t wanted)
{
    uint64_t until = mcu->cycle + REACH;
    for (const avr_cycle_timer_slot_t *slot = mcu->cycle_timers.timer; slot != NULL && slot->when <= until;
         slot = slot->next) {
        if (promises(kind_of(slot), wanted)) {
            return slot->when + CHAIN;
        }
    }
    return NEVER;
}

/* Lets time pass, with the work of the other parts, until then or until an interrupt can be served. */
static void wait_until(uint64_t at)
{
    uint64_t began = mcu->cycle;
    while (next.at <= at && mcu->interrupt_state == 0 && mcu->state == cpu_Running && !resets_wanted()) {
        mcu->cycle = next.at > mcu->cycle ? next.at : mcu->cycle;
        avr_cycle_timer_process(mcu);
        note_next_timer();
    }
    waits++;
    waited_cycles += mcu->cycle - began;
    if (mcu->interrupt_state > 0 && !resets_wanted()) {
        avr_service_interrupts(mcu);
        if (next.at <= mcu->cycle) { /* the entry took time: as in step() of the machine */
            avr_cycle_timer_process(mcu);
        }
    }
}

/* In a handler, on entry or later. */
static void on_handler_step(void)
{
    uint32_t vector = mcu->pc / VECTOR_BYTES;
    if (vector != 0 && vector < VECTORS) {
        running = vector;
        served |= 1u << vector;
    }
    if (running != 0) {
        note_in_handler(mcu->pc);
    }
}

/* Before an instruction of main: what was served since the previous one, and whether to wait; true if it did. */
static bool ahead_of(place_t *place)
{
    if (served != 0) {
        mark(place, BEFORE);
        mark(last, AFTER);
        served = 0;
    }
    if (!mcu->sreg[S_I] || mcu->interrupt_state != 0) {
        return false;
    }
    uint32_t wanted = lacking(place, BEFORE) | lacking(last, AFTER);
    uint64_t at = wanted == 0 ? NEVER : expected(wanted);
    if (at == NEVER) {
        return false;
    }
    wait_until(at);
    return true;
}

bool race_on_step(bool awake)
{
    if (file == NULL) {
        return false;
    }
    note_next_timer();
    if (!awake || mcu_in_boot_loader(mcu->pc)) {
        running = 0; /* interrupts in the meantime are not tracked */
        served = 0;
        last = NULL;
        return false;
    }
    place_t *place = place_at(mcu->pc);
    bool waited = !times_in_interrupt() && ahead_of(place);
    if (times_in_interrupt()) {
        on_handler_step();
    } else {
        note_in_main(place, mcu->pc);
        last = place;
    }
    return waited;
}

/* The first byte that this instruction shares with that handler. */
static const char *shared_with(const place_t *place, unsigned vector)
{
    for (unsigned i = 0; i < place->touched_count; i++) {
        uint32_t mask = sharers(place->touched[i].address, place->touched[i].reads, place->touched[i].writes);
        if ((mask >> vector & 1u) != 0) {
            return access_name(place->touched[i].address);
        }
    }
    return "?";
}

static const char *count_pair(const place_t *place, unsigned vector)
{
    if (place->taken[BEFORE][vector] != 0 || place->taken[AFTER][vector] != 0) {
        count.taken++;
        return "taken";
    }
    if (!place->open) {
        count.guarded++;
        return "guarded";
    }
    count.not_reached++;
    return "not reached";
}

static void close_place(place_t *place, uint32_t pc)
{
    for (unsigned i = 0; i < place->touched_count; i++) { /* a handler may have accessed it later than main */
        place->vectors |= sharers(place->touched[i].address, place->touched[i].reads, place->touched[i].writes);
    }
    for (unsigned v = 1; v < VECTORS; v++) {
        if ((place->vectors >> v & 1u) != 0) {
            const char *state = count_pair(place, v);
            fprintf(file, "0x%04x,%s,", (unsigned)pc, symbols_nearest(pc));
            fprintf(file, "%s,%s,%u,%u,%s\n", shared_with(place, v), times_vector_name(v),
                    (unsigned)place->taken[BEFORE][v], (unsigned)place->taken[AFTER][v], state);
        }
    }
}

void race_finish(void)
{
    if (file == NULL) {
        return;
    }
    fputs("pc,symbol,variable,vector,before,after,state\n", file);
    for (uint32_t word = 0; word < FLASH_WORDS; word++) {
        close_place(&places[word], word * 2);
    }
    output_close(file, file_path);
    fprintf(stderr, "simrun: race: %u pairs taken, %u guarded, %u not reached; %llu waits of %llu cycles in all\n",
            count.taken, count.guarded, count.not_reached, (unsigned long long)waits,
            (unsigned long long)waited_cycles);
}
