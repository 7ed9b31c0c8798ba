/* The judge in the machine: the firmware's clock starts with Timer1, rows come from the UART. */
#include "sim_io.h"
#include "simrun.h"

enum { REG_TCCR1B = 0x81, CLOCK_SELECT = 0x07 };

static judge_t judge;

static void on_timer(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    (void)address;
    (void)param;
    if ((value & CLOCK_SELECT) != 0) {
        judge_clock_begins(&judge, avr->cycle);
    }
}

void verdict_start(void)
{
    judge = (judge_t){ .cycles_per_us = CYCLES_PER_US, .start_us = options.clock_start_us };
    avr_register_io_write(mcu, REG_TCCR1B, on_timer, NULL);
}

void verdict_on_row(const row_t *row)
{
    size_t count;
    served_t *served = sensor_served_lately(&count);
    (void)judge_row(&judge, row, served, count, sensor_true_period_us());
}

void verdict_print(FILE *json)
{
    fprintf(json, "  \"rows_judged\": %u,\n  \"rows_wrong\": %u,\n  \"rows_stale\": %u,\n",
            (unsigned)judge_judged(&judge), (unsigned)judge.count[JUDGE_WRONG], (unsigned)judge.count[JUDGE_STALE]);
    fprintf(json, "  \"rows_twice\": %u,\n  \"t_us_steps_back\": %u,\n", (unsigned)judge.count[JUDGE_TWICE],
            (unsigned)judge.steps_back);
}

void verdict_tell(void)
{
    if (judge.rows_seen != 0) {
        fprintf(stderr, "simrun: %s\n", judge_summary(&judge));
    }
}

const char *verdict_reason(void)
{
    return options.judge && judge.any_fault ? judge_summary(&judge) : NULL;
}
