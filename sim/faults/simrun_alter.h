/* Faults that alter values or clocks: the kinds from KIND_FLIP on. */
#ifndef SIMRUN_ALTER_H
#define SIMRUN_ALTER_H

#include <stdbool.h>
#include <stdint.h>

#include "simrun_faults_parse.h"
#include "twi_peripheral.h"

void alter_start(const char *path, twi_peripheral_t *twi); /* of --altered; NULL: none */
void alter_finish(void);
uint32_t alter_count(void);                        /* samples that arrived different from what was sent */
const int16_t *alter_sample(const int16_t lsb[3]); /* what the sensor measures instead */
uint64_t alter_next(void);
void alter_step(void);
void alter_begin(const fault_t *fault);
void alter_end(const fault_t *fault); /* the last of its kind */
bool alter_waits(kind_t kind); /* it happens once, has begun, and the byte or reading that it alters has not come yet */

#endif
