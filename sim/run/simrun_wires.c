/* The pull-ups and the capacitance of SDA and SCL, which make them rise late (twi_wires.h). */
#include "simrun_wires.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* an RC rising from 0: to 0.7 VCC, where an input is sure to see a one, and from 0.3 to 0.7 VCC (UM10204) */
#define TO_ONE (-log(0.3))
#define RISE_TIME log(0.7 / 0.3)
#define NS_PER_OHM_PF 1e-3

static double scl_rc_ns, sda_rc_ns;

/* Parses a number within these bounds; returns the text after it, NULL if it is not legal. */
static char *bounded(const char *text, double low, double high, double *value)
{
    char *end;
    *value = strtod(text, &end);
    return end != text && *value >= low && *value <= high ? end : NULL;
}

static char *farads(const char *rest, double *pf)
{
    return rest != NULL && *rest == ',' ? bounded(rest + 1, 0.0, 10000.0, pf) : NULL;
}

bool wires_take(const char *argument)
{
    double ohm, scl_pf, sda_pf;
    const char *rest = farads(bounded(argument, 100.0, 100000.0, &ohm), &scl_pf);
    if (rest == NULL) {
        return false;
    }
    sda_pf = scl_pf;
    if (*rest != '\0') {
        rest = farads(rest, &sda_pf);
    }
    scl_rc_ns = ohm * scl_pf * NS_PER_OHM_PF;
    sda_rc_ns = ohm * sda_pf * NS_PER_OHM_PF;
    return rest != NULL && *rest == '\0';
}

void wires_start(twi_peripheral_t *twi)
{
    twi->rise_scl_ns = scl_rc_ns * TO_ONE;
    twi->rise_sda_ns = sda_rc_ns * TO_ONE;
    if (scl_rc_ns > 0.0 || sda_rc_ns > 0.0) {
        fprintf(stderr,
                "simrun: wires: SCL rises in %.0f ns, SDA in %.0f; I2C allows 300 at 400 kHz, 1000 at 100 kHz\n",
                scl_rc_ns * RISE_TIME, sda_rc_ns * RISE_TIME);
    }
}
