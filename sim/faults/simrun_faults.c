/*
 * WHEN they begin, WHAT they do, how long a state lasts, and how long the firmware takes until the first good row after
 * it: a row that its flags do not disown (simrun_judge.h) and that shows a sample latched after the fault had ended.
 */
#include "simrun_faults.h"

#include <string.h>

#include "simrun_alter.h"
#include "simrun_eeprom.h"
#include "simrun_events.h"
#include "simrun_faults_parse.h"
#include "simrun_mcu.h"
#include "simrun_resets.h"
#include "simrun_sensor.h"
#include "simrun_starve.h"
#include "simrun_vcd.h"

enum { LOOK_BACK = 64 };

static fault_t faults[FAULTS_MAX];
static size_t fault_count;
static twi_peripheral_t *twi;

/* A state that several faults can hold is released by the last of them. */
static bool any_active(kind_t kind)
{
    for (size_t i = 0; i < fault_count; i++) {
        if (faults[i].kind == kind && faults[i].active) {
            return true;
        }
    }
    return false;
}

static void follow_lines(void)
{
    bool sda = any_active(KIND_SDA);
    bool scl = any_active(KIND_SCL);
    twi_hold(twi, sda, scl);
    vcd_change(VCD_SDA_LOW, sda);
    vcd_change(VCD_SCL_LOW, scl);
}

static void follow_int1(void)
{
    sensor_hold_int1(any_active(KIND_NOINT), any_active(KIND_INTHIGH));
}

static void set_power(bool on)
{
    adxl345_model_power(&sensor, on);
    sensor_check_rate();
}

/* What the next byte or transfer does wrong once, of a fault that is only that; else NULL. */
static bool *wrong_once(kind_t kind)
{
    switch (kind) {
    case KIND_ARB:
        return &twi->lose_arbitration;
    case KIND_BUSERR:
        return &twi->bus_error;
    case KIND_NACK:
        return &twi->nack_address;
    case KIND_NACKDATA:
        return &twi->nack_data;
    case KIND_TORN:
        return &twi->let_go;
    default:
        return NULL;
    }
}

static void reset_mcu(const fault_t *fault)
{
    if (fault->kind == KIND_MCUPOWER) {
        eeprom_leave((eeprom_left_t)fault->parameter);
        resets_want(RESET_POWER_ON);
    } else {
        resets_want(fault->kind == KIND_BROWNOUT ? RESET_BROWN_OUT : RESET_EXTERNAL);
    }
}

/* Starts a state, or does all of a fault that does not last. */
static void apply(const fault_t *fault)
{
    bool *wrong = wrong_once(fault->kind);
    if (wrong != NULL) {
        *wrong = true;
        return;
    }
    switch (fault->kind) {
    case KIND_HANG:
        twi_hang(twi, (unsigned)fault->parameter);
        break;
    case KIND_UNPLUG:
    case KIND_POWER:
        set_power(false);
        break;
    case KIND_PLUG:
        set_power(true);
        break;
    case KIND_SDA:
    case KIND_SCL:
        follow_lines();
        break;
    case KIND_DEVID:
        sensor.device_id = sensor.reg[0] = (uint8_t)fault->parameter;
        break;
    case KIND_NOINT:
    case KIND_INTHIGH:
        follow_int1();
        break;
    case KIND_STARVE:
    case KIND_OVERRUN:
        starve(true);
        break;
    case KIND_POKE:
        mcu->data[fault->address] = (uint8_t)fault->parameter;
        break;
    default:
        reset_mcu(fault);
        break;
    }
}

static void release(fault_t *fault)
{
    fault->active = false;
    fault->ends = NEVER;
    fault->awaits_row = true;
    fault->ended_at = mcu->cycle;
    if (fault->kind >= KIND_FLIP) {
        if (!any_active(fault->kind)) {
            alter_end(fault);
        }
        return;
    }
    switch (fault->kind) {
    case KIND_UNPLUG:
    case KIND_POWER:
        set_power(true);
        break;
    case KIND_DEVID:
        sensor.device_id = sensor.reg[0] = sensor.variant->device_id;
        break;
    case KIND_NOINT:
    case KIND_INTHIGH:
        follow_int1();
        break;
    case KIND_STARVE:
    case KIND_OVERRUN:
        starve(any_active(KIND_STARVE) || any_active(KIND_OVERRUN));
        break;
    default:
        follow_lines();
        break;
    }
}

/* The fault has not struck yet: it still needs a byte, an acknowledge, or the bus after a time without activity. */
static bool waits(const fault_t *fault)
{
    switch (fault->kind) {
    case KIND_ARB:
        return twi->lose_arbitration;
    case KIND_BUSERR:
        return twi->bus_error;
    case KIND_NACK:
        return twi->nack_address;
    case KIND_NACKDATA:
        return twi->nack_data;
    case KIND_TORN:
        return twi->let_go;
    default:
        return alter_waits(fault->kind);
    }
}

void faults_after_byte(void)
{
    for (size_t i = 0; i < fault_count; i++) {
        fault_t *fault = &faults[i];
        if (fault->awaits_byte && !waits(fault)) {
            fault->awaits_byte = false;
            fault->awaits_row = true;
            fault->ended_at = mcu->cycle;
        }
    }
}

static void begin(fault_t *fault)
{
    fault->injected++;
    if (fault->injected == 1) {
        fault->first_ms = mcu_ms();
    }
    fault->armed = fault->when == WHEN_SAMPLE;
    fault->overruns_before = sensor.overruns;
    if (fault_kinds[fault->kind].lasts) {
        fault->active = true;
        fault->awaits_row = false;
        fault->ends = fault->lasts == NEVER ? NEVER : mcu->cycle + fault->lasts;
    } else {
        fault->awaits_row = true;
        fault->ended_at = mcu->cycle;
    }
    if (fault->kind >= KIND_FLIP) {
        alter_begin(fault);
    } else {
        apply(fault);
    }
    if (waits(fault)) {
        fault->awaits_byte = true;
        fault->awaits_row = false;
    }
    events_reschedule();
}

uint64_t faults_next(void)
{
    uint64_t next = alter_next();
    for (size_t i = 0; i < fault_count; i++) {
        const fault_t *fault = &faults[i];
        uint64_t at = fault->active ? fault->ends : NEVER;
        if (fault->when == WHEN_MS && fault->armed) {
            at = fault->at;
        }
        next = at < next ? at : next;
    }
    return next;
}

void faults_step(void)
{
    alter_step();
    for (size_t i = 0; i < fault_count; i++) {
        fault_t *fault = &faults[i];
        if (fault->when == WHEN_MS && fault->armed && fault->at <= mcu->cycle) {
            begin(fault);
        } else if (fault->active && fault->ends <= mcu->cycle) {
            release(fault);
        }
    }
}

/* A bus fault strikes at a random byte of the read that follows, which is as long as the previous transfer. */
static void on_chance(fault_t *fault)
{
    if (fault_kinds[fault->kind].on_bus) {
        fault->bytes_left = 1u + mcu_random() % (twi->byte == 0 ? 1u : twi->byte);
    } else if (!fault->active) {
        begin(fault);
    }
}

static void on_sample(void)
{
    for (size_t i = 0; i < fault_count; i++) {
        fault_t *fault = &faults[i];
        uint32_t overruns = sensor.overruns - fault->overruns_before;
        if (fault->kind == KIND_OVERRUN && fault->active && overruns >= (uint32_t)fault->parameter) {
            release(fault);
        }
        if (fault->when == WHEN_SAMPLE && mcu_random() < fault->chance) {
            on_chance(fault);
        }
    }
}

void faults_on_byte(uint32_t transfer, uint32_t byte)
{
    for (size_t i = 0; i < fault_count; i++) {
        fault_t *fault = &faults[i];
        bool named = fault->when == WHEN_BYTE && fault->armed && fault->transfer == transfer && fault->byte == byte;
        if (named || (fault->bytes_left != 0 && --fault->bytes_left == 0)) {
            begin(fault);
        }
    }
}

static void on_eeprom_write(uint32_t count, eeprom_moment_t moment)
{
    for (size_t i = 0; i < fault_count; i++) {
        fault_t *fault = &faults[i];
        bool named = fault->when == WHEN_EEPROM && fault->eeprom_write == count && fault->eeprom_moment == moment;
        if (named && fault->armed) {
            begin(fault);
        }
    }
}

bool faults_start(const faults_options_t *wanted, twi_peripheral_t *bus)
{
    bool watches_pc = false;
    twi = bus;
    sensor_hook(alter_sample, on_sample);
    eeprom_on_write(on_eeprom_write);
    for (; fault_count < wanted->count; fault_count++) {
        fault_parse(&faults[fault_count], wanted->texts[fault_count]);
        watches_pc = watches_pc || faults[fault_count].when == WHEN_PC;
    }
    return watches_pc;
}

void faults_on_pc(uint32_t pc)
{
    for (size_t i = 0; i < fault_count; i++) {
        fault_t *fault = &faults[i];
        if (fault->when == WHEN_PC && fault->armed && fault->pc == pc && --fault->visits_left == 0) {
            begin(fault);
        }
    }
}

void faults_on_reset(void)
{
    for (size_t i = 0; i < fault_count; i++) {
        bool starves = faults[i].kind == KIND_STARVE || faults[i].kind == KIND_OVERRUN;
        if (starves && faults[i].active) {
            release(&faults[i]);
        }
    }
}

static bool shows_sample_since(const row_t *row, uint64_t since)
{
    size_t count;
    const served_t *lately = sensor_served_lately(&count);
    for (size_t i = count; i > 0 && i + LOOK_BACK > count; i--) {
        const served_t *served = &lately[i - 1];
        if (served->cycle < since) {
            return false;
        }
        if (memcmp(served->lsb, row->lsb, sizeof row->lsb) == 0) {
            return true;
        }
    }
    return false;
}

void faults_on_row(const row_t *row)
{
    bool good = (row->flags & JUDGE_DISOWNED) == 0;
    for (size_t i = 0; good && i < fault_count; i++) {
        fault_t *fault = &faults[i];
        if (fault->awaits_row && shows_sample_since(row, fault->ended_at)) {
            double ms = (double)(row->sent - fault->ended_at) / CYCLES_PER_MS;
            fault->awaits_row = false;
            fault->recovered++;
            fault->worst_ms = ms > fault->worst_ms ? ms : fault->worst_ms;
        }
    }
}

bool faults_over(void)
{
    bool any = false;
    for (size_t i = 0; i < fault_count; i++) {
        const fault_t *fault = &faults[i];
        if (fault->active || fault->awaits_byte || fault->awaits_row) {
            return false;
        }
        any = any || fault->injected != 0;
    }
    return any;
}

void faults_print(FILE *json)
{
    for (size_t i = 0; i < fault_count; i++) {
        const fault_t *fault = &faults[i];
        unsigned n = (unsigned)i + 1;
        fprintf(json, "  \"fault_%u\": \"%s\",\n  \"fault_%u_injected\": %u,\n  \"fault_%u_recovered\": %u,\n", n,
                fault->text, n, (unsigned)fault->injected, n, (unsigned)fault->recovered);
        fprintf(json, "  \"fault_%u_detectable\": %s,\n", n, fault_kinds[fault->kind].detectable ? "true" : "false");
        fprintf(json, "  \"fault_%u_last_end_ms\": %.3f,\n", n, (double)fault->ended_at / CYCLES_PER_MS);
        fprintf(json, "  \"fault_%u_first_ms\": %.3f,\n  \"fault_%u_worst_recovery_ms\": %.3f,\n", n, fault->first_ms,
                n, fault->worst_ms);
    }
}

void faults_warn(void)
{
    for (size_t i = 0; i < fault_count; i++) {
        if (faults[i].injected == 0) {
            fprintf(stderr, "simrun: --fault %s never came\n", faults[i].text);
        }
    }
}
