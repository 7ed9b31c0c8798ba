/*
 * Drives a fuzz target where there is no libFuzzer: mutates inputs (fuzz_mutate.c) and keeps those that reach new code,
 * as told by gcc's -fsanitize-coverage=trace-pc.
 *
 *   fuzz_TARGET --seconds N --seed N --work DIR [--dict FILE] CORPUS...    DIR/corpus gets what is new, DIR/current
 *                                                                          holds the input that runs: whatever ends
 *                                                                          this process
 *   fuzz_TARGET FILE...                                                    runs these inputs once
 */
#define _GNU_SOURCE
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "fuzz.h"
#include "fuzz_drive.h"

enum { MAP_SIZE = 1 << 16, CORPUS_MAX = 20000, HANG_SECONDS = 20, DEFAULT_LENGTH = 600 };

static uint8_t hits[MAP_SIZE];
static uint8_t seen[MAP_SIZE];
static uintptr_t previous_pc;
static blob_t corpus[CORPUS_MAX];
static size_t corpus_count;
static current_t *current;
static const char *work;
static unsigned long executions;
static unsigned long long bytes_run;
static unsigned reached;

extern char __executable_start[];

/* Called by the program under test at each basic block. */
void __sanitizer_cov_trace_pc(void);
void __sanitizer_cov_trace_pc(void)
{
    uintptr_t pc = (uintptr_t)__builtin_return_address(0) - (uintptr_t)__executable_start;
    uintptr_t edge = (pc * 40503u ^ previous_pc) % MAP_SIZE;
    hits[edge] = (uint8_t)(hits[edge] + (hits[edge] != UINT8_MAX));
    previous_pc = (pc * 40503u) >> 1;
}

void fuzz_stop(const char *what, const char *path)
{
    fprintf(stderr, "fuzz: %s: %s: %s\n", path, what, strerror(errno));
    exit(2);
}

/* One bit for each class of counts: 1, 2-3, 4-7, 8-15, ... */
static uint8_t class_of(uint8_t count)
{
    unsigned bit = 1;
    for (unsigned rest = count; rest > 1; rest >>= 1) {
        bit <<= 1;
    }
    return (uint8_t)bit;
}

/* Runs the current input; true when it reached an edge, or a count of one, that none before did. */
static bool run_current(void)
{
    memset(hits, 0, sizeof hits);
    previous_pc = 0;
    alarm(HANG_SECONDS);
    uint8_t *copy = malloc(current->size + (current->size == 0)); /* on the heap, so that reading beyond it is seen */
    if (copy == NULL) {
        fuzz_stop("out of memory", "input");
    }
    memcpy(copy, current->bytes, current->size);
    (void)LLVMFuzzerTestOneInput(copy, current->size);
    free(copy);
    alarm(0);
    executions++;
    bytes_run += current->size;
    bool fresh = false;
    for (size_t i = 0; i < MAP_SIZE; i++) {
        uint8_t class = hits[i] == 0 ? 0 : class_of(hits[i]);
        if ((class & (uint8_t)~seen[i]) != 0) {
            reached += seen[i] == 0;
            seen[i] |= class;
            fresh = true;
        }
    }
    return fresh;
}

blob_t fuzz_kept(const uint8_t *bytes, size_t size)
{
    uint8_t *kept = malloc(size + 1);
    if (kept == NULL) {
        fuzz_stop("out of memory", "an input kept");
    }
    memcpy(kept, bytes, size);
    return (blob_t){ kept, size };
}

static void keep_current(void)
{
    if (corpus_count < CORPUS_MAX) {
        corpus[corpus_count++] = fuzz_kept(current->bytes, current->size);
    }
}

static uint64_t hash(const uint8_t *bytes, size_t size)
{
    uint64_t h = 14695981039346656037u;
    for (size_t i = 0; i < size; i++) {
        h = (h ^ bytes[i]) * 1099511628211u;
    }
    return h;
}

static void write_current(void)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/corpus/%016llx", work, (unsigned long long)hash(current->bytes, current->size));
    FILE *file = fopen(path, "wb");
    if (file == NULL || fwrite(current->bytes, 1, current->size, file) != current->size || fclose(file) != 0) {
        fuzz_stop("cannot write", path);
    }
}

static void load_current(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        fuzz_stop("cannot open", path);
    }
    current->size = (uint32_t)fread(current->bytes, 1, INPUT_MAX, file);
    fclose(file);
}

static void load_folder(const char *folder)
{
    struct dirent **entry;
    int count = scandir(folder, &entry, NULL, alphasort);
    if (count < 0) {
        fuzz_stop("cannot read the corpus", folder);
    }
    for (int i = 0; i < count; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", folder, entry[i]->d_name);
        if (entry[i]->d_name[0] != '.') {
            load_current(path);
            if (run_current()) {
                keep_current();
            }
        }
        free(entry[i]);
    }
    free(entry);
}

static double seconds_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void make_input(size_t length_max)
{
    /* every other time one of the newest, which are the least explored */
    size_t newest = corpus_count < 16 ? corpus_count : 16;
    size_t pick = mutate_below(2) == 0 ? corpus_count - 1 - mutate_below(newest) : mutate_below(corpus_count);
    current->size = (uint32_t)corpus[pick].size;
    memcpy(current->bytes, corpus[pick].bytes, corpus[pick].size);
    for (size_t times = 1 + mutate_below(1 + ((size_t)1 << mutate_below(5))); times != 0; times--) {
        mutate_once(current, corpus, corpus_count, length_max);
    }
}

static void fuzz(double seconds, size_t length_max)
{
    double end = seconds_now() + seconds;
    if (corpus_count == 0) {
        current->size = 0;
        keep_current();
    }
    size_t given = corpus_count;
    while (seconds_now() < end) {
        make_input(length_max);
        if (run_current()) {
            keep_current();
            write_current();
        }
    }
    printf("%lu inputs, %llu bytes, %u edges, %zu of the corpus count, %zu new\n", executions, bytes_run, reached,
           given, corpus_count - given);
}

static void share_current(void)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/corpus", work);
    (void)mkdir(path, 0777);
    snprintf(path, sizeof path, "%s/current", work);
    int file = open(path, O_RDWR | O_CREAT | O_TRUNC, 0666);
    if (file < 0 || ftruncate(file, sizeof *current) != 0) {
        fuzz_stop("cannot make", path);
    }
    current = mmap(NULL, sizeof *current, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (current == MAP_FAILED) {
        fuzz_stop("cannot map", path);
    }
}

static int replay(int count, char *path[])
{
    static current_t own;
    current = &own;
    for (int i = 0; i < count; i++) {
        load_current(path[i]);
        (void)run_current();
        printf("%s: no failure\n", path[i]);
    }
    return 0;
}

typedef struct {
    double seconds;
    size_t length_max;
    const char *dictionary;
} options_t;

static bool set_option(options_t *o, const char *name, const char *value)
{
    if (strcmp(name, "--seconds") == 0) {
        o->seconds = atof(value);
    } else if (strcmp(name, "--seed") == 0) {
        mutate_seed(strtoull(value, NULL, 10));
    } else if (strcmp(name, "--work") == 0) {
        work = value;
    } else if (strcmp(name, "--dict") == 0) {
        o->dictionary = value;
    } else if (strcmp(name, "--length") == 0) {
        size_t length = strtoull(value, NULL, 10);
        o->length_max = length < INPUT_MAX ? length : INPUT_MAX;
    } else {
        return false;
    }
    return true;
}

int main(int argc, char *argv[])
{
    options_t options = { .length_max = DEFAULT_LENGTH };
    int at = 1;
    for (; at + 1 < argc && strncmp(argv[at], "--", 2) == 0; at += 2) {
        if (!set_option(&options, argv[at], argv[at + 1])) {
            fprintf(stderr, "fuzz: unknown option %s\n", argv[at]);
            return 2;
        }
    }
    if (work == NULL) {
        return replay(argc - at, &argv[at]);
    }
    share_current();
    if (options.dictionary != NULL) {
        dictionary_load(options.dictionary);
    }
    for (; at < argc; at++) {
        load_folder(argv[at]);
    }
    fuzz(options.seconds, options.length_max);
    return 0;
}
