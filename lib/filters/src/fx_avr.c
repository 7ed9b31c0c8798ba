/*
 * The functions of fx.h in assembler for the ATmega328P; fx.c has them in C for other machines.
 *
 * A product is built in two halves of its own and moved in the end to the registers of the first operand, where a
 * function returns its result, so hardly any function has to save a register. A byte of an operand that is known to be
 * 0 is reused as scratch.
 */
#include "fx.h"

#ifdef FX_ASSEMBLER
MACHINE_APART uint32_t filter_fx_mul_uq16(uint32_t a, uint16_t b_uq16)
{
    uint16_t low; /* bytes 2..5 of the 6-byte product; of byte 1 only the top bit is needed, of byte 0 nothing */
    uint16_t high;
    uint8_t zero;
    uint8_t byte1;
    __asm__("clr %[z]\n\t"
            "mul %B[a],%B[b]\n\tmovw %A[l],r0\n\t"
            "mul %D[a],%B[b]\n\tmovw %A[h],r0\n\t"
            "mul %A[a],%A[b]\n\tmov %[n],r1\n\t"
            "mul %C[a],%A[b]\n\tadd %A[l],r0\n\tadc %B[l],r1\n\tadc %A[h],%[z]\n\tadc %B[h],%[z]\n\t"
            "mul %D[a],%A[b]\n\tadd %B[l],r0\n\tadc %A[h],r1\n\tadc %B[h],%[z]\n\t"
            "mul %C[a],%B[b]\n\tadd %B[l],r0\n\tadc %A[h],r1\n\tadc %B[h],%[z]\n\t"
            "mul %B[a],%A[b]\n\tadd %[n],r0\n\tadc %A[l],r1\n\tadc %B[l],%[z]\n\tadc %A[h],%[z]\n\tadc %B[h],%[z]\n\t"
            "mul %A[a],%B[b]\n\tadd %[n],r0\n\tadc %A[l],r1\n\tadc %B[l],%[z]\n\tadc %A[h],%[z]\n\tadc %B[h],%[z]\n\t"
            "lsl %[n]\n\tadc %A[l],%[z]\n\tadc %B[l],%[z]\n\tadc %A[h],%[z]\n\tadc %B[h],%[z]\n\t"
            "movw %A[a],%A[l]\n\tmovw %C[a],%A[h]\n\tclr r1"
            : [a] "+r"(a), [l] "=&r"(low), [h] "=&r"(high), [z] "=&r"(zero), [n] "=&r"(byte1)
            : [b] "r"(b_uq16));
    return a;
}

MACHINE_APART uint16_t filter_fx_mul16_uq16(uint16_t a, uint16_t b_uq16)
{
    uint16_t product; /* bytes 2 and 3 of the 4-byte product; of byte 1 only the carry and the top bit are needed */
    uint8_t zero;
    uint8_t byte1;
    __asm__("clr %[z]\n\t"
            "mul %A[a],%A[b]\n\tmov %[n],r1\n\t"
            "mul %B[a],%B[b]\n\tmovw %A[p],r0\n\t"
            "mul %B[a],%A[b]\n\tadd %[n],r0\n\tadc %A[p],r1\n\tadc %B[p],%[z]\n\t"
            "mul %A[a],%B[b]\n\tadd %[n],r0\n\tadc %A[p],r1\n\tadc %B[p],%[z]\n\t"
            "lsl %[n]\n\tadc %A[p],%[z]\n\tadc %B[p],%[z]\n\t"
            "movw %A[a],%A[p]\n\tclr r1"
            : [a] "+r"(a), [p] "=&r"(product), [z] "=&r"(zero), [n] "=&r"(byte1)
            : [b] "r"(b_uq16));
    return a;
}

MACHINE_APART uint32_t filter_fx_mul24_uq16(uint32_t a_q8, uint16_t b_uq16)
{
    uint16_t low; /* bytes 1..4 of the 5-byte product; byte 0 only rounds */
    uint16_t high;
    uint8_t byte0; /* D[a] is 0 */
    __asm__("mul %A[a],%A[b]\n\tmov %[n],r0\n\tmov %A[l],r1\n\t"
            "mul %B[a],%B[b]\n\tmov %B[l],r0\n\tmov %A[h],r1\n\tclr %B[h]\n\tclr %D[a]\n\t"
            "mul %B[a],%A[b]\n\tadd %A[l],r0\n\tadc %B[l],r1\n\tadc %A[h],%D[a]\n\tadc %B[h],%D[a]\n\t"
            "mul %A[a],%B[b]\n\tadd %A[l],r0\n\tadc %B[l],r1\n\tadc %A[h],%D[a]\n\tadc %B[h],%D[a]\n\t"
            "mul %C[a],%A[b]\n\tadd %B[l],r0\n\tadc %A[h],r1\n\tadc %B[h],%D[a]\n\t"
            "mul %C[a],%B[b]\n\tadd %A[h],r0\n\tadc %B[h],r1\n\t"
            "lsl %[n]\n\tadc %A[l],%D[a]\n\tadc %B[l],%D[a]\n\tadc %A[h],%D[a]\n\tadc %B[h],%D[a]\n\t"
            "movw %A[a],%A[l]\n\tmovw %C[a],%A[h]\n\tclr r1"
            : [a] "+r"(a_q8), [l] "=&r"(low), [h] "=&r"(high), [n] "=&r"(byte0)
            : [b] "r"(b_uq16));
    return a_q8;
}

MACHINE_APART uint32_t filter_fx_mul24_uq24(uint32_t a_q8, uint32_t b_uq24)
{
    uint16_t low; /* bytes 2..5 of the 6-byte product; of byte 1, in D[b], only the carry and the top bit are needed */
    uint16_t high;
    __asm__("clr %D[a]\n\t" /* 0 */
            "mul %A[a],%A[b]\n\tmov %D[b],r1\n\t"
            "mul %B[a],%B[b]\n\tmovw %A[l],r0\n\t"
            "mul %C[a],%C[b]\n\tmovw %A[h],r0\n\t"
            "mul %C[a],%A[b]\n\tadd %A[l],r0\n\tadc %B[l],r1\n\tadc %A[h],%D[a]\n\tadc %B[h],%D[a]\n\t"
            "mul %A[a],%C[b]\n\tadd %A[l],r0\n\tadc %B[l],r1\n\tadc %A[h],%D[a]\n\tadc %B[h],%D[a]\n\t"
            "mul %C[a],%B[b]\n\tadd %B[l],r0\n\tadc %A[h],r1\n\tadc %B[h],%D[a]\n\t"
            "mul %B[a],%C[b]\n\tadd %B[l],r0\n\tadc %A[h],r1\n\tadc %B[h],%D[a]\n\t"
            "mul %B[a],%A[b]\n\tadd %D[b],r0\n\tadc %A[l],r1\n\t"
            "adc %B[l],%D[a]\n\tadc %A[h],%D[a]\n\tadc %B[h],%D[a]\n\t"
            "mul %A[a],%B[b]\n\tadd %D[b],r0\n\tadc %A[l],r1\n\t"
            "adc %B[l],%D[a]\n\tadc %A[h],%D[a]\n\tadc %B[h],%D[a]\n\t"
            "lsl %D[b]\n\tadc %A[l],%D[a]\n\tadc %B[l],%D[a]\n\tadc %A[h],%D[a]\n\tadc %B[h],%D[a]\n\t"
            "movw %A[a],%A[l]\n\tmovw %C[a],%A[h]\n\tclr r1"
            : [a] "+r"(a_q8), [b] "+r"(b_uq24), [l] "=&x"(low), [h] "=&z"(high));
    return a_q8;
}

MACHINE_APART uint32_t filter_fx_mul_uq24(uint32_t a, uint32_t b_uq24)
{
    uint16_t low; /* bytes 3..6 of the 7-byte product; of bytes 1 and 2 only the carry and the top bit are needed */
    uint16_t high;
    uint8_t byte1;
    uint8_t byte2;
    __asm__("clr %D[b]\n\t" /* 0 */
            "mul %B[a],%C[b]\n\tmovw %A[l],r0\n\t"
            "mul %D[a],%C[b]\n\tmovw %A[h],r0\n\t"
            "mul %A[a],%A[b]\n\tmov %[n],r1\n\t"
            "mul %B[a],%B[b]\n\tmov %[m],r0\n\t"
            "add %A[l],r1\n\tadc %B[l],%D[b]\n\tadc %A[h],%D[b]\n\tadc %B[h],%D[b]\n\t"
            "mul %C[a],%B[b]\n\tadd %A[l],r0\n\tadc %B[l],r1\n\tadc %A[h],%D[b]\n\tadc %B[h],%D[b]\n\t"
            "mul %D[a],%A[b]\n\tadd %A[l],r0\n\tadc %B[l],r1\n\tadc %A[h],%D[b]\n\tadc %B[h],%D[b]\n\t"
            "mul %C[a],%C[b]\n\tadd %B[l],r0\n\tadc %A[h],r1\n\tadc %B[h],%D[b]\n\t"
            "mul %D[a],%B[b]\n\tadd %B[l],r0\n\tadc %A[h],r1\n\tadc %B[h],%D[b]\n\t"
            "mul %C[a],%A[b]\n\tadd %[m],r0\n\tadc %A[l],r1\n\t"
            "adc %B[l],%D[b]\n\tadc %A[h],%D[b]\n\tadc %B[h],%D[b]\n\t"
            "mul %A[a],%C[b]\n\tadd %[m],r0\n\tadc %A[l],r1\n\t"
            "adc %B[l],%D[b]\n\tadc %A[h],%D[b]\n\tadc %B[h],%D[b]\n\t"
            "mul %B[a],%A[b]\n\tadd %[n],r0\n\tadc %[m],r1\n\t"
            "adc %A[l],%D[b]\n\tadc %B[l],%D[b]\n\tadc %A[h],%D[b]\n\tadc %B[h],%D[b]\n\t"
            "mul %A[a],%B[b]\n\tadd %[n],r0\n\tadc %[m],r1\n\t"
            "adc %A[l],%D[b]\n\tadc %B[l],%D[b]\n\tadc %A[h],%D[b]\n\tadc %B[h],%D[b]\n\t"
            "lsl %[m]\n\tadc %A[l],%D[b]\n\tadc %B[l],%D[b]\n\tadc %A[h],%D[b]\n\tadc %B[h],%D[b]\n\t"
            "movw %A[a],%A[l]\n\tmovw %C[a],%A[h]\n\tclr r1"
            : [a] "+r"(a), [b] "+r"(b_uq24), [l] "=&x"(low), [h] "=&z"(high), [n] "=&r"(byte1), [m] "=&r"(byte2));
    return a;
}

MACHINE_APART uint32_t filter_fx_shift_right(uint32_t v, uint8_t places)
{
    __asm__("1:\tcpi %[n],8\n\tbrlo 2f\n\t"
            "mov %A[v],%B[v]\n\tmov %B[v],%C[v]\n\tmov %C[v],%D[v]\n\tclr %D[v]\n\tsubi %[n],8\n\trjmp 1b\n"
            "2:\tsubi %[n],1\n\tbrcs 3f\n\tlsr %D[v]\n\tror %C[v]\n\tror %B[v]\n\tror %A[v]\n\trjmp 2b\n"
            "3:"
            : [v] "+r"(v), [n] "+&d"(places));
    return v;
}
#endif
