#define _GNU_SOURCE
#include "support/recordings.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define FIELDS_MAX 40U
#define FOLDER "../shared/streams"

const rest_t recording_rests[RESTS] = {
    { "gy85-tilt-92hz", 0, 23 },    { "uav-arm-100-a", 0, 6 },
    { "uav-hover-poll166", 0, 10 }, { "printer-400-rest-zdown", 0, 60 },
    { "sis-fall-rail", 11, 15 },    { "sis-garbled", 9.5, 15 },
    { "sis-zero-read-a", 8.5, 12 }, { "sis-lie-slow", 0, 2 },
    { "sis-lie-slow", 6, 8 },       { "sis-roll90", 0, 1.5 },
    { "kl3200-rest-zup", 0, 1e9 },  { "freeimu-orient-a", 54.9, 80 },
    { "freeimu-orient-a", 0, 17 },
};

const char *recordings_folder(void)
{
    const char *folder = getenv("RECORDINGS");
    return folder != NULL && *folder != '\0' ? folder : FOLDER;
}

bool recordings_there(void)
{
    return strcmp(recordings_folder(), FOLDER) != 0 || access(FOLDER "/open/index.csv", R_OK) == 0;
}

/* The end of a field that begins here, in quotes or not. */
static char *end_of_field(char *at)
{
    bool quoted = false;
    while (*at != '\0' && *at != '\n' && *at != '\r' && (quoted || *at != ',')) {
        quoted = *at == '"' ? !quoted : quoted;
        at++;
    }
    return at;
}

/* Cuts a line of CSV at its commas; returns the number of fields. No column that counts is in quotes. */
static size_t cut(char *line, char *field[FIELDS_MAX])
{
    size_t count = 0;
    char *at = line;
    bool more = true;
    while (more && count < FIELDS_MAX) {
        field[count++] = at;
        at = end_of_field(at);
        more = *at == ',';
        *at++ = '\0';
    }
    return count;
}

/* Names and places of the columns that count. */
enum { NAME, ROWS, RATE, STEP, RANGE, CLIP, DUPLICATES, ZEROS, ONES, COLUMNS };
static const char *const column_name[COLUMNS] = { "name",      "n",     "rate_hz_nominal",
                                                  "dt_med_us", "range", "clip_frac",
                                                  "dup_frac",  "all0",  "allm1" };

static bool find_columns(char *line, size_t place[COLUMNS])
{
    char *field[FIELDS_MAX];
    size_t count = cut(line, field);
    for (size_t c = 0; c < COLUMNS; c++) {
        place[c] = 0;
        while (place[c] < count && strcmp(field[place[c]], column_name[c]) != 0) {
            place[c]++;
        }
        if (place[c] == count) {
            return false;
        }
    }
    return true;
}

static void fill(recording_t *r, const char *folder, char *field[FIELDS_MAX], const size_t place[COLUMNS])
{
    snprintf(r->name, sizeof r->name, "%s", field[place[NAME]]);
    snprintf(r->path, sizeof r->path, "%s/%s.csv", folder, field[place[NAME]]);
    int range_g = atoi(field[place[RANGE]]);
    r->range_g = (uint8_t)(range_g == 2 || range_g == 4 || range_g == 8 ? range_g : 16);
    r->rows = (size_t)atol(field[place[ROWS]]);
    r->rate_dhz = (uint16_t)(10.0 * atof(field[place[RATE]]) + 0.5);
    r->step_us = atof(field[place[STEP]]);
    r->clipped = atof(field[place[CLIP]]);
    r->duplicates = atof(field[place[DUPLICATES]]);
    r->zeros = (size_t)atol(field[place[ZEROS]]);
    r->ones = (size_t)atol(field[place[ONES]]);
}

static bool read_rows(recordings_t *recordings, FILE *file, const char *folder)
{
    char line[4096];
    size_t place[COLUMNS];
    size_t columns = 0;
    if (fgets(line, sizeof line, file) == NULL || !find_columns(line, place)) {
        return false;
    }
    for (size_t c = 0; c < COLUMNS; c++) {
        columns = place[c] >= columns ? place[c] + 1 : columns;
    }
    while (fgets(line, sizeof line, file) != NULL) {
        char *field[FIELDS_MAX];
        if (cut(line, field) < columns || recordings->count == RECORDINGS_MAX) {
            return false;
        }
        fill(&recordings->list[recordings->count++], folder, field, place);
    }
    return true;
}

static bool load_index(recordings_t *recordings, const char *part)
{
    char folder[400];
    char path[440];
    snprintf(folder, sizeof folder, "%s/%s", recordings_folder(), part);
    snprintf(path, sizeof path, "%s/index.csv", folder);
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        snprintf(recordings->error, sizeof recordings->error, "%s: cannot open", path);
        return false;
    }
    bool good = read_rows(recordings, file, folder);
    fclose(file);
    if (!good) {
        snprintf(recordings->error, sizeof recordings->error, "%s: a column is missing, or more than %u recordings",
                 path, RECORDINGS_MAX);
    }
    return good;
}

bool recordings_load(recordings_t *recordings)
{
    memset(recordings, 0, sizeof *recordings);
    return load_index(recordings, "open") && load_index(recordings, "test-only");
}

const recording_t *recordings_find(const recordings_t *recordings, const char *name)
{
    for (size_t i = 0; i < recordings->count; i++) {
        if (strcmp(recordings->list[i].name, name) == 0) {
            return &recordings->list[i];
        }
    }
    return NULL;
}
