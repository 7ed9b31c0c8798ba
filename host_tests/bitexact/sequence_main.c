/*
 * filter_sequence [UPDATES STEP]: the sequence of filter_sequence.h, on the PC 10^7 updates in steps of 10^6 unless
 * told otherwise, on the chip 10^5 in steps of 10^4; a line per step: updates, CRC-32, configurations begun, drawn in
 * vain. The last line is in Unity's form.
 */
#include "crc32.h"
#include "filter_sequence.h"
#include "output.h"

#ifndef __AVR__
#include <stdlib.h>
#endif

static filter_sequence_t sequence;

static void print_step(void)
{
    output_u32(sequence.updates);
    output_char(' ');
    output_hex(crc32_value(sequence.crc), 8);
    output_char(' ');
    output_u32(sequence.episode);
    output_char(' ');
    output_u32(sequence.refused);
    output_char('\n');
}

static void print_broken(const char *broken)
{
    output_text("filter_sequence.c:any_sequence_stays_within_bounds:FAIL: bound of '");
    output_text(broken);
    output_text("', filter number ");
    output_u32(sequence.kind);
    output_text(", episode ");
    output_u32(sequence.episode);
    output_text(", call ");
    output_u32(sequence.calls);
    output_char('\n');
}

static int run(uint32_t end, uint32_t step)
{
    const char *broken = NULL;
    output_start();
    sequence_start(&sequence);
    for (uint32_t updates = step; broken == NULL && updates <= end; updates += step) {
        broken = sequence_run(&sequence, updates);
        print_step();
    }
    if (broken != NULL) {
        print_broken(broken);
    } else {
        output_text("filter_sequence.c:any_sequence_stays_within_bounds:PASS\n");
    }
    output_text("\n1 Tests ");
    output_char(broken != NULL ? '1' : '0');
    output_text(" Failures 0 Ignored\n");
    output_end();
    return broken != NULL;
}

#ifdef __AVR__
int main(void)
{
    return run(100000UL, 10000UL);
}
#else
int main(int argc, char **argv)
{
    uint32_t end = (argc == 3) ? (uint32_t)strtoul(argv[1], NULL, 10) : 10000000U;
    uint32_t step = (argc == 3) ? (uint32_t)strtoul(argv[2], NULL, 10) : 1000000U;
    if (end == 0U || step == 0U) {
        output_text("filter_sequence: usage: filter_sequence [UPDATES STEP], both positive\n");
        return 2;
    }
    return run(end, step);
}
#endif
