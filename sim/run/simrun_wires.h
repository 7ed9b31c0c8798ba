/* The wires of the bus (--wires). */
#ifndef SIMRUN_WIRES_H
#define SIMRUN_WIRES_H

#include <stdbool.h>

#include "twi_peripheral.h"

bool wires_take(const char *argument); /* OHM,PF or OHM,PF,PF_OF_SDA; false: it is not legal */
void wires_start(twi_peripheral_t *twi);

#endif
