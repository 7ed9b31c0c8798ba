/*
 * One axis through some filters, each with its defaults and told R, as a picture or a table of a page needs it:
 *
 *   roll_replay RATE_DHZ R_LSB2 FILTER... < SAMPLES > ESTIMATES
 *
 * SAMPLES: a whole number of LSB a line; `-` starts all filters anew. ESTIMATES: for each sample a line with the
 * estimates in LSB, in the order of the filters, separated by commas.
 */
#include "filter_list.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FILTERS_MAX = 8, LINE = 32 };

static filter_t filters[FILTERS_MAX];
static filter_kind_t kinds[FILTERS_MAX];
static int count;

static int refuse(const char *what, const char *text)
{
    fprintf(stderr, "roll_replay: %s: %s\n", text, what);
    return 2;
}

static bool start(uint16_t rate_dhz, uint32_t r_lsb2_q8)
{
    for (int i = 0; i < count; i++) {
        filter_config_t config = filter_defaults(filter_listed(kinds[i]), rate_dhz);
        if (filter_init(&filters[i], filter_listed(kinds[i]), &config) != FILTER_ACCEPTED) {
            return false;
        }
        filter_set_noise(&filters[i], r_lsb2_q8);
    }
    return true;
}

static void step(int16_t z_lsb)
{
    for (int i = 0; i < count; i++) {
        int32_t x_lsb_q16 = filter_update(&filters[i], z_lsb);
        printf("%s%.4f", i != 0 ? "," : "", x_lsb_q16 / 65536.0);
    }
    putchar('\n');
}

static int replay(uint16_t rate_dhz, uint32_t r_lsb2_q8)
{
    char line[LINE];
    while (fgets(line, sizeof line, stdin) != NULL) {
        line[strcspn(line, "\n")] = '\0';
        char *end = line;
        long z_lsb = strtol(line, &end, 10);
        if (strcmp(line, "-") == 0) {
            (void)start(rate_dhz, r_lsb2_q8);
        } else if (end == line || *end != '\0' || z_lsb < -4096 || z_lsb > 4095) {
            return refuse("a whole number from -4096 to 4095, or - was expected", line);
        } else {
            step((int16_t)z_lsb);
        }
    }
    return 0;
}

int main(int argc, char **argv)
{
    if (argc < 4 || argc > 3 + FILTERS_MAX) {
        return refuse("RATE_DHZ R_LSB2 and one to eight filters were expected", "arguments");
    }
    long rate_dhz = strtol(argv[1], NULL, 10);
    double r_lsb2 = strtod(argv[2], NULL);
    if (rate_dhz < FILTER_RATE_MIN_DHZ || rate_dhz > FILTER_RATE_MAX_DHZ) {
        return refuse("a rate from 50 to 40000 tenths of a Hz was expected", argv[1]);
    }
    if (!(r_lsb2 * 256.0 >= FILTER_R_MIN_LSB2_Q8 && r_lsb2 * 256.0 <= FILTER_R_MAX_LSB2_Q8)) {
        return refuse("a variance from 0.012 to 1000 LSB^2 was expected", argv[2]);
    }
    for (; count < argc - 3; count++) {
        kinds[count] = filter_find(argv[3 + count]);
        if (kinds[count] == FILTER_KIND_COUNT) {
            return refuse("there is no such filter", argv[3 + count]);
        }
    }
    uint32_t r_lsb2_q8 = (uint32_t)(r_lsb2 * 256.0 + 0.5);
    if (!start((uint16_t)rate_dhz, r_lsb2_q8)) {
        return refuse("a filter refuses its own defaults", argv[1]);
    }
    return replay((uint16_t)rate_dhz, r_lsb2_q8);
}
