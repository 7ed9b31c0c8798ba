/*
 * The inline primitives of fx.h in assembler for the ATmega328P. Included by fx.h only, where the contract of each is
 * given with its C version (fx_..._c). __zero_reg__ (r1) holds half a product in the meantime: an interrupt saves and
 * clears it, and so does the end of each primitive.
 */
#ifndef FX_AVR_H
#define FX_AVR_H

/* The assembler versions are in use; fx_dot.h tests for this. */
#define FX_ASSEMBLER

MACHINE_INLINE uint16_t fx_upper(const uint32_t *v)
{
    uint16_t upper;
    __builtin_memcpy(&upper, (const uint8_t *)v + 2, sizeof upper);
    return upper;
}

MACHINE_INLINE int16_t fx_upper_signed(const int32_t *v)
{
    int16_t upper;
    __builtin_memcpy(&upper, (const uint8_t *)v + 2, sizeof upper);
    return upper;
}

MACHINE_INLINE uint32_t fx_shift12(uint16_t v)
{
    uint32_t shifted;
    uint8_t nibble;
    __asm__("clr %A[s]\n\t"
            "mov %B[s],%A[v]\n\tswap %B[s]\n\tmov %C[s],%B[s]\n\t"
            "ldi %[n],0xF0\n\tand %B[s],%[n]\n\teor %C[s],%B[s]\n\t"
            "mov %D[s],%B[v]\n\tswap %D[s]\n\tand %[n],%D[s]\n\tor %C[s],%[n]\n\teor %D[s],%[n]"
            : [s] "=&r"(shifted), [n] "=&d"(nibble)
            : [v] "r"(v));
    return shifted;
}

MACHINE_INLINE uint32_t fx_eightfold(uint32_t v)
{
    __asm__("lsl %A[v]\n\trol %B[v]\n\trol %C[v]\n\trol %D[v]\n\t"
            "lsl %A[v]\n\trol %B[v]\n\trol %C[v]\n\trol %D[v]\n\t"
            "lsl %A[v]\n\trol %B[v]\n\trol %C[v]\n\trol %D[v]"
            : [v] "+r"(v));
    return v;
}

MACHINE_INLINE uint32_t fx_sixteenth(uint32_t v)
{
    __asm__("lsr %D[v]\n\tror %C[v]\n\tror %B[v]\n\tror %A[v]\n\t"
            "lsr %D[v]\n\tror %C[v]\n\tror %B[v]\n\tror %A[v]\n\t"
            "lsr %D[v]\n\tror %C[v]\n\tror %B[v]\n\tror %A[v]\n\t"
            "lsr %D[v]\n\tror %C[v]\n\tror %B[v]\n\tror %A[v]\n\t"
            "adc %A[v],__zero_reg__\n\tadc %B[v],__zero_reg__\n\tadc %C[v],__zero_reg__\n\tadc %D[v],__zero_reg__"
            : [v] "+r"(v));
    return v;
}

MACHINE_INLINE uint8_t fx_normalise(uint32_t *v)
{
    uint32_t bits = *v;
    uint8_t places;
    __asm__("clr %[n]\n"
            "1:\ttst %D[v]\n\tbrmi 4f\n\tbrne 3f\n\t"
            "mov %D[v],%C[v]\n\tmov %C[v],%B[v]\n\tmov %B[v],%A[v]\n\tclr %A[v]\n\tsubi %[n],0xF8\n\trjmp 1b\n"
            "3:\tinc %[n]\n\tlsl %A[v]\n\trol %B[v]\n\trol %C[v]\n\trol %D[v]\n\tbrpl 3b\n"
            "4:"
            : [v] "+r"(bits), [n] "=&d"(places));
    *v = bits;
    return places;
}

/*
 * With one bit set in part_uq8 the halves of neighbouring products have no bits in common; the rounding half is the
 * borrow.
 */
MACHINE_INLINE int32_t fx_without_part(int32_t v, uint8_t part_uq8)
{
    uint8_t byte0;
    uint8_t byte1;
    uint8_t byte2;
    uint8_t lost;
    __asm__("mul %A[v],%[n]\n\tmov %[l],r0\n\tmov %[p],r1\n\t"
            "mul %B[v],%[n]\n\tor %[p],r0\n\tmov %[q],r1\n\t"
            "mul %C[v],%[n]\n\tor %[q],r0\n\tmov %[r],r1\n\t"
            "mulsu %D[v],%[n]\n\tor %[r],r0\n\t"
            "lsl %[l]\n\tsbc %A[v],%[p]\n\tsbc %B[v],%[q]\n\tsbc %C[v],%[r]\n\tsbc %D[v],r1\n\t"
            "clr r1"
            : [v] "+&a"(v), [p] "=&r"(byte0), [q] "=&r"(byte1), [r] "=&r"(byte2), [l] "=&r"(lost)
            : [n] "a"(part_uq8));
    return v;
}

/*
 * Checks the highest byte only: a value with the same highest byte as the limit counts as beyond it, with the same
 * result.
 */
MACHINE_INLINE int32_t fx_clamp_high(int32_t v, uint8_t limit)
{
    uint8_t top;
    __asm__("mov %[t],%D[v]\n\tsubi %[t],-%[l]\n\tcpi %[t],2*%[l]\n\tbrlo 1f\n\t"
            "clr %A[v]\n\tclr %B[v]\n\tclr %C[v]\n\tlsl %D[v]\n\tldi %D[v],%[l]\n\tbrcc 1f\n\tneg %D[v]\n"
            "1:"
            : [v] "+&d"(v), [t] "=&d"(top)
            : [l] "M"(limit));
    return v;
}

#endif
