/*
 * nav_chip ELF SECONDS: the flight of paper 003 through nav/lib in the simulated chip, 100 Hz IMU, 10 Hz field, 1 Hz
 * GPS and altimeter, drift of the gyro on; beside it the same records through the same code on the PC. Prints per
 * call: how often, cycles mean and most; the mean load; the stack; slots by their job; and how many states differ in
 * any bit. Status 1: they differ, or the chip went wrong.
 */
#include "nav_box.h"
#include "support/flight.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gelf.h>
#include <libelf.h>

#include <sim_avr.h>
#include <sim_core.h>
#include <sim_elf.h>

#define CLOCK 16000000.0
enum { GPIOR0 = 0x3E, GPIOR2 = 0x4B, RATE = 100, JOBS = 4 };

static const char *const call_names[NAV_CALLS] = { "", "init", "imu", "gps", "down", "field" };
static const char *const job_names[JOBS] = { "take in", "scalar", "noise", "nothing" };

typedef struct {
    unsigned long n;
    double sum;
    unsigned long long most;
} cycles_t;

typedef struct {
    avr_t *avr;
    uint32_t nav_at, config_at, box_at, bss_end;
    nav_t nav;
    nav_config_t config;
    nav_box_t box;
    test_random_t random;
    int k, steps;
    bool ended;
    avr_cycle_count_t began;
    uint8_t inside;
    cycles_t call[NAV_CALLS], job[JOBS];
    int job_now;
    unsigned long differ;
    unsigned deepest;
} chip_t;

static void add(cycles_t *c, unsigned long long cycles)
{
    c->n++;
    c->sum += (double)cycles;
    c->most = (cycles > c->most) ? cycles : c->most;
}

static void real3(float *to, const double *from)
{
    for (int i = 0; i < 3; i++) {
        to[i] = (float)from[i];
    }
}

static void set_config(nav_config_t *c)
{
    flight_truth_t truth;
    flight_truth(&truth, 0.0);
    double length = sqrt(1.0 + 3.0 * 0.05 * 0.05);
    const double lambda[4] = { 1.0 / length, 0.05 / length, -0.05 / length, 0.05 / length };
    double q[4];
    flight_product(q, truth.quaternion, lambda);
    memset(c, 0, sizeof *c);
    for (int i = 0; i < 4; i++) {
        c->start.quaternion[i] = (float)q[i];
    }
    for (int i = 0; i < 3; i++) {
        c->start.velocity_mps[i] = (float)(1.01 * truth.velocity[i]);
        c->start.position_m[i] = (float)(1.01 * truth.position[i]);
    }
    real3(c->field, flight_field);
    c->gravity_mps2 = 9.81F;
    c->start_position_m = 57.3F;
    c->start_velocity_mps = 1.2F;
    c->start_attitude_rad = 0.02F;
    c->start_drift_rps = 1e-3F;
    c->walk_position_m = 5e-7F;
    c->walk_velocity_mps = 1e-4F;
    c->walk_attitude_rad = 3e-5F;
    c->sigma_field = 0.0349F;
    c->sigma_gps_velocity_mps = 0.1F;
    c->sigma_gps_position_m = 5.0F;
    c->sigma_down_m = 1.0F;
    c->gate = 5.0F;
    c->period_us = 10000;
}

static void next_record(chip_t *chip)
{
    flight_sample_t sample;
    flight_sample(&sample, chip->k, &flight_gyro_drift, &chip->random);
    nav_box_t *box = &chip->box;
    int end = chip->k + 1;
    double t = end * FLIGHT_STEP;
    real3(box->rate, sample.rate);
    real3(box->force, sample.force);
    real3(box->velocity, sample.gps_velocity);
    real3(box->position, sample.gps_position);
    real3(box->field, sample.field);
    box->down = (float)sample.down;
    box->t_us = (uint32_t)end * 10000U;
    bool gps = end % RATE == 0 && (t <= 160.0 || t >= 400.0);
    box->calls = (uint8_t)((1U << NAV_CALL_IMU) | (gps ? 1U << NAV_CALL_GPS : 0U) |
                           (end % RATE == 0 ? 1U << NAV_CALL_DOWN : 0U) |
                           (end % (RATE / 10) == 0 ? 1U << NAV_CALL_FIELD : 0U));
}

/* The same record on the PC, and which job its slot did. */
static void on_pc(chip_t *chip)
{
    const nav_box_t *box = &chip->box;
    nav_t *nav = &chip->nav;
    uint8_t arrived = nav->queue.arrived;
    uint16_t waits = nav->queue.waits;
    nav_imu(nav, box->t_us, box->rate, box->force);
    chip->job_now = (arrived != nav->queue.arrived) ? 0 : ((waits != nav->queue.waits) ? 1 : 2);
    if ((box->calls & (1U << NAV_CALL_GPS)) != 0U) {
        nav_gps(nav, box->t_us, box->velocity, box->position);
    }
    if ((box->calls & (1U << NAV_CALL_DOWN)) != 0U) {
        nav_down(nav, box->t_us, box->down);
    }
    if ((box->calls & (1U << NAV_CALL_FIELD)) != 0U) {
        nav_field(nav, box->t_us, box->field);
    }
}

static void on_gpior2(struct avr_t *avr, avr_io_addr_t address, uint8_t value, void *parameter)
{
    chip_t *chip = parameter;
    avr->data[address] = value;
    if (value == NAV_ASKS_CONFIG) {
        memcpy(avr->data + chip->config_at, &chip->config, sizeof chip->config);
    } else if (value == NAV_ASKS_RECORD) {
        next_record(chip);
        memcpy(avr->data + chip->box_at, &chip->box, sizeof(float) * 16U + 5U);
        on_pc(chip);
    } else if (value == NAV_TELLS_STATE) {
        /* state and covariance come first in nav_t, and have no padding on either machine */
        chip->differ += memcmp(avr->data + chip->nav_at, &chip->nav, sizeof(nav_state_t) + sizeof chip->nav.ud) != 0;
        chip->k++;
        chip->ended = chip->k >= chip->steps;
    } else {
        fprintf(stderr, "nav_chip: nav_init refused on the chip\n");
        exit(1);
    }
}

static void on_gpior0(struct avr_t *avr, avr_io_addr_t address, uint8_t value, void *parameter)
{
    chip_t *chip = parameter;
    avr->data[address] = value;
    if (value != 0U) {
        chip->inside = value;
        chip->began = avr->cycle;
        return;
    }
    unsigned long long cycles = avr->cycle - chip->began;
    add(&chip->call[chip->inside], cycles);
    if (chip->inside == NAV_CALL_IMU) {
        add(&chip->job[chip->job_now], cycles);
    }
}

/* Address of a symbol in the data space. */
static uint32_t symbol(Elf *elf, const char *name)
{
    Elf_Scn *section = NULL;
    GElf_Shdr header;
    while ((section = elf_nextscn(elf, section)) != NULL) {
        gelf_getshdr(section, &header);
        if (header.sh_type != SHT_SYMTAB) {
            continue;
        }
        Elf_Data *data = elf_getdata(section, NULL);
        for (int i = 0; i < (int)(header.sh_size / header.sh_entsize); i++) {
            GElf_Sym found;
            gelf_getsym(data, i, &found);
            if (strcmp(elf_strptr(elf, header.sh_link, found.st_name), name) == 0) {
                return (uint32_t)(found.st_value & 0xFFFFU);
            }
        }
    }
    fprintf(stderr, "nav_chip: no symbol %s\n", name);
    exit(2);
}

static void find_symbols(chip_t *chip, const char *path)
{
    elf_version(EV_CURRENT);
    FILE *file = fopen(path, "rb");
    Elf *elf = (file == NULL) ? NULL : elf_begin(fileno(file), ELF_C_READ, NULL);
    if (elf == NULL) {
        fprintf(stderr, "nav_chip: cannot read %s\n", path);
        exit(2);
    }
    chip->nav_at = symbol(elf, "nav");
    chip->config_at = symbol(elf, "config");
    chip->box_at = symbol(elf, "box");
    chip->bss_end = symbol(elf, "__bss_end");
    elf_end(elf);
    fclose(file);
}

static void load(chip_t *chip, const char *path)
{
    elf_firmware_t firmware;
    memset(&firmware, 0, sizeof firmware);
    find_symbols(chip, path);
    if (elf_read_firmware(path, &firmware) != 0) {
        exit(2);
    }
    chip->avr = avr_make_mcu_by_name("atmega328p");
    avr_init(chip->avr);
    chip->avr->frequency = 16000000;
    avr_load_firmware(chip->avr, &firmware);
    avr_register_io_write(chip->avr, GPIOR0, on_gpior0, chip);
    avr_register_io_write(chip->avr, GPIOR2, on_gpior2, chip);
}

static int run(chip_t *chip)
{
    avr_t *avr = chip->avr;
    while (!chip->ended) {
        int state = avr_run(avr);
        unsigned sp = (unsigned)avr->data[R_SPL] | ((unsigned)avr->data[R_SPH] << 8U);
        if (state == cpu_Done || state == cpu_Crashed || (sp < chip->bss_end && sp > 0U)) {
            fprintf(stderr, "nav_chip: the chip crashed, or its stack met its data, at record %d\n", chip->k);
            return 1;
        }
        unsigned depth = (sp > 0U) ? avr->ramend - sp : 0U;
        chip->deepest = (depth > chip->deepest) ? depth : chip->deepest;
    }
    return 0;
}

static void report(const chip_t *chip)
{
    double all = 0.0;
    for (int i = NAV_CALL_INIT; i < NAV_CALLS; i++) {
        const cycles_t *c = &chip->call[i];
        printf("call %s: %lu, mean %.0f, most %llu cycles\n", call_names[i], c->n,
               c->n > 0 ? c->sum / (double)c->n : 0.0, c->most);
        all += (i == NAV_CALL_INIT) ? 0.0 : c->sum;
    }
    for (int i = 0; i < JOBS - 1; i++) {
        const cycles_t *c = &chip->job[i];
        printf("slot with %s: %lu, mean %.0f, most %llu cycles\n", job_names[i], c->n,
               c->n > 0 ? c->sum / (double)c->n : 0.0, c->most);
    }
    printf("load %.1f %%; static %u, stack %u bytes; %lu of %d states differ from the PC\n",
           100.0 * all / (CLOCK * chip->k / RATE), (unsigned)(chip->bss_end - 0x100U), chip->deepest, chip->differ,
           chip->k);
}

int main(int argc, char **argv)
{
    static chip_t chip;
    if (argc != 3) {
        fprintf(stderr, "nav_chip ELF SECONDS\n");
        return 2;
    }
    random_seed(&chip.random, 7);
    chip.steps = RATE * atoi(argv[2]);
    set_config(&chip.config);
    if (!nav_init(&chip.nav, &chip.config)) {
        return 2;
    }
    load(&chip, argv[1]);
    int status = run(&chip);
    report(&chip);
    return (status != 0 || chip.differ != 0U) ? 1 : 0;
}
