#include "simrun_access.h"

#include <stdio.h>

#include "simrun_mcu.h"
#include "simrun_symbols.h"

enum { REG_X = 26, REG_Y = 28, REG_Z = 30, IO_OFFSET = 0x20 };

static uint16_t pair(unsigned low)
{
    return (uint16_t)(mcu->data[low] | mcu->data[low + 1] << 8);
}

static access_t access_to(unsigned address, bool writes)
{
    return (access_t){ .address = (uint16_t)address, .reads = !writes, .writes = writes };
}

/* LDS and STS, and LD and ST with a pointer that may change. */
static access_t direct(unsigned opcode, uint32_t pc)
{
    bool writes = (opcode & 0x0200u) != 0;
    switch (opcode & 0xFu) {
    case 0x0:
        return access_to(mcu_opcode_at(pc + 2), writes);
    case 0x1:
        return access_to(pair(REG_Z), writes);
    case 0x2:
        return access_to(pair(REG_Z) - 1u, writes);
    case 0x9:
        return access_to(pair(REG_Y), writes);
    case 0xA:
        return access_to(pair(REG_Y) - 1u, writes);
    case 0xC:
    case 0xD:
        return access_to(pair(REG_X), writes);
    case 0xE:
        return access_to(pair(REG_X) - 1u, writes);
    default: /* LPM, PUSH, POP */
        return (access_t){ 0 };
    }
}

static access_t displaced(unsigned opcode)
{
    unsigned offset = (opcode & 7u) | (opcode >> 7 & 0x18u) | (opcode >> 8 & 0x20u);
    return access_to(pair((opcode & 8u) != 0 ? REG_Y : REG_Z) + offset, (opcode & 0x0200u) != 0);
}

static access_t bit(unsigned opcode)
{
    bool writes = (opcode & 0x0100u) == 0; /* SBI, CBI also read it; SBIS, SBIC only read it */
    return (access_t){ .address = (uint16_t)((opcode >> 3 & 0x1Fu) + IO_OFFSET), .reads = true, .writes = writes };
}

access_t access_at(uint32_t pc)
{
    unsigned opcode = mcu_opcode_at(pc);
    if ((opcode & 0xFC00u) == 0x9000u) {
        return direct(opcode, pc);
    }
    if ((opcode & 0xD000u) == 0x8000u) {
        return displaced(opcode);
    }
    if ((opcode & 0xF000u) == 0xB000u) {
        return access_to((opcode & 0xFu) + (opcode >> 5 & 0x30u) + IO_OFFSET, (opcode & 0x0800u) != 0);
    }
    if ((opcode & 0xFC00u) == 0x9800u) {
        return bit(opcode);
    }
    return (access_t){ 0 };
}

const char *access_name(uint16_t address)
{
    static const struct {
        uint16_t address;
        const char *name;
    } registers[] = { { 0x29, "PIND" },   { 0x36, "TIFR1" },
                      { 0x3C, "EIFR" },   { 0x3D, "EIMSK" },
                      { 0x3E, "GPIOR0" }, { 0x4A, "GPIOR1" },
                      { 0x4B, "GPIOR2" }, { 0x6F, "TIMSK1" },
                      { 0x84, "TCNT1L" }, { 0x85, "TCNT1H" },
                      { 0x88, "OCR1AL" }, { 0x89, "OCR1AH" },
                      { 0x8A, "OCR1BL" }, { 0x8B, "OCR1BH" },
                      { 0xB8, "TWBR" },   { 0xB9, "TWSR" },
                      { 0xBB, "TWDR" },   { 0xBC, "TWCR" },
                      { 0xC0, "UCSR0A" }, { 0xC1, "UCSR0B" },
                      { 0xC6, "UDR0" },   { TIMER1_TEMP, "TEMP of Timer1" } };
    static char number[16];
    for (size_t i = 0; i < sizeof registers / sizeof registers[0]; i++) {
        if (registers[i].address == address) {
            return registers[i].name;
        }
    }
    if (address >= RAM_START) {
        return symbols_variable_at(address);
    }
    snprintf(number, sizeof number, "0x%02x", (unsigned)address);
    return number;
}
