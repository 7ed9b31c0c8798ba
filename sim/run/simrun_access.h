/* The address in data space that an instruction reads or writes; stack instructions do not count. */
#ifndef SIMRUN_ACCESS_H
#define SIMRUN_ACCESS_H

#include <stdbool.h>
#include <stdint.h>

/* the byte through which all the high ones of Timer1 go; not an address of data space */
enum { TIMER1_TEMP = 0x900 };

typedef struct {
    uint16_t address; /* in data space */
    bool reads, writes;
} access_t;

access_t access_at(uint32_t pc);           /* neither reads nor writes: no access, or one to the stack */
const char *access_name(uint16_t address); /* of a register or variable; static text */

#endif
