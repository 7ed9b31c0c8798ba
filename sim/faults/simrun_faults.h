/* The faults of the command line: when they begin and end, and how long until a good row. */
#ifndef SIMRUN_FAULTS_H
#define SIMRUN_FAULTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "simrun_judge.h"
#include "twi_peripheral.h"

enum { FAULTS_MAX = 64 };

typedef struct {
    const char *texts[FAULTS_MAX];
    size_t count;
} faults_options_t;

/* Needs the symbols; exits with EXIT_INPUT and the reason. True: one waits for a place in the program. */
bool faults_start(const faults_options_t *wanted, twi_peripheral_t *bus);
uint64_t faults_next(void);
void faults_step(void);
void faults_on_byte(uint32_t transfer, uint32_t byte);
void faults_after_byte(void);
void faults_on_pc(uint32_t pc);
void faults_on_row(const row_t *row);
bool faults_over(void);     /* some faults have occurred, none is in progress, and each has had its good row */
void faults_on_reset(void); /* of the MCU: ends starvation */
void faults_print(FILE *json);
void faults_warn(void); /* stderr: faults that never occurred */

#endif
