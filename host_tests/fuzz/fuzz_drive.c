/*
 * Drives a fuzz target where there is no libFuzzer: mutates inputs and keeps those that reach new code, as told by gcc's
 * -fsanitize-coverage=trace-pc.
 *
 *   fuzz_TARGET --seconds N --seed N --work DIR [--dict FILE] CORPUS...    DIR/corpus gets what is new, DIR/current holds
 *                                                                          the input that runs: whatever ends this process
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

enum {
    MAP_SIZE = 1 << 16,
    INPUT_MAX = 4096,
    CORPUS_MAX = 20000,
    TOKENS_MAX = 256,
    HANG_SECONDS = 20,
    DEFAULT_LENGTH = 600
};

typedef struct {
    uint8_t *bytes;
    size_t size;
} blob_t;

/* In shared memory, so that the input outlives the process. */
typedef struct {
    uint32_t size;
    uint8_t bytes[INPUT_MAX];
} current_t;

static uint8_t hits[MAP_SIZE];
static uint8_t seen[MAP_SIZE];
static uintptr_t previous_pc;
static blob_t corpus[CORPUS_MAX];
static size_t corpus_count;
static blob_t token[TOKENS_MAX];
static size_t token_count;
static current_t *current;
static uint64_t random_state;
static const char *work;
static unsigned long executions;
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

static _Noreturn void stop(const char *what, const char *path)
{
    fprintf(stderr, "fuzz: %s: %s: %s\n", path, what, strerror(errno));
    exit(2);
}

static uint32_t random_u32(void)
{
    random_state ^= random_state >> 12;
    random_state ^= random_state << 25;
    random_state ^= random_state >> 27;
    return (uint32_t)((random_state * 2685821657736338717u) >> 32);
}

static size_t below(size_t end)
{
    return end == 0 ? 0 : (size_t)(((uint64_t)random_u32() * end) >> 32);
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
        stop("out of memory", "input");
    }
    memcpy(copy, current->bytes, current->size);
    (void)LLVMFuzzerTestOneInput(copy, current->size);
    free(copy);
    alarm(0);
    executions++;
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

static void keep_current(void)
{
    if (corpus_count == CORPUS_MAX) {
        return;
    }
    blob_t *blob = &corpus[corpus_count++];
    blob->size = current->size;
    blob->bytes = malloc(current->size + 1);
    if (blob->bytes == NULL) {
        stop("out of memory", "corpus");
    }
    memcpy(blob->bytes, current->bytes, current->size);
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
        stop("cannot write", path);
    }
}

static void load_current(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        stop("cannot open", path);
    }
    current->size = (uint32_t)fread(current->bytes, 1, INPUT_MAX, file);
    fclose(file);
}

static void load_folder(const char *folder)
{
    struct dirent **entry;
    int count = scandir(folder, &entry, NULL, alphasort);
    if (count < 0) {
        stop("cannot read the corpus", folder);
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

/* Lines of the form "text" with \xNN; anything else is a comment. */
static void load_dictionary(const char *path)
{
    char line[256];
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        stop("cannot open", path);
    }
    while (fgets(line, sizeof line, file) != NULL && token_count < TOKENS_MAX) {
        char *end = strrchr(line, '"');
        if (line[0] != '"' || end == line) {
            continue;
        }
        *end = '\0';
        uint8_t *bytes = malloc(sizeof line);
        if (bytes == NULL) {
            stop("out of memory", path);
        }
        size_t size = 0;
        for (const char *at = line + 1; *at != '\0'; at++) {
            unsigned value = (uint8_t)*at;
            if (at[0] == '\\' && at[1] == 'x' && sscanf(at + 2, "%2x", &value) == 1) {
                at += 3;
            }
            bytes[size++] = (uint8_t)value;
        }
        token[token_count++] = (blob_t){ bytes, size };
    }
    fclose(file);
}

/* Replaces `cut` bytes at `at` by these, as far as there is room. */
static void put_piece(size_t at, size_t cut, const uint8_t *bytes, size_t size)
{
    size_t tail = current->size - at - cut;
    if (at + size + tail > INPUT_MAX) {
        return;
    }
    memmove(&current->bytes[at + size], &current->bytes[at + cut], tail);
    memcpy(&current->bytes[at], bytes, size);
    current->size = (uint32_t)(at + size + tail);
}

static void mutate_byte(size_t at)
{
    static const uint8_t edge[] = { 0, 1, 0x7F, 0x80, 0xFF, ' ', '0', '9', '\n', ',' };
    uint8_t *byte = &current->bytes[at];
    switch (below(4)) {
    case 0:
        *byte ^= (uint8_t)(1u << below(8));
        break;
    case 1:
        *byte = (uint8_t)(*byte + below(33) - 16);
        break;
    case 2:
        *byte = edge[below(sizeof edge)];
        break;
    default:
        *byte = (uint8_t)random_u32();
        break;
    }
}

static void mutate_once(size_t length_max)
{
    uint8_t piece[INPUT_MAX];
    size_t at = below(current->size + 1u);
    size_t rest = current->size - at;
    size_t room = length_max > current->size ? length_max - current->size : 0;
    const blob_t *other = &corpus[below(corpus_count)];
    size_t from = below(other->size);
    size_t size = below(1 + (below(4) == 0 ? 64 : 8));
    switch (below(8)) {
    case 0: /* take out */
        put_piece(at, size < rest ? size : rest, piece, 0);
        break;
    case 1: /* double a piece of its own */
        size = size < rest ? size : rest;
        memcpy(piece, &current->bytes[at], size);
        put_piece(at, 0, piece, size < room ? size : 0);
        break;
    case 2: /* a piece of another input */
        size = size < other->size - from ? size : other->size - from;
        put_piece(at, below(2) == 0 && size <= rest ? size : 0, &other->bytes[from], size < room ? size : 0);
        break;
    case 3:
        if (token_count != 0) {
            const blob_t *word = &token[below(token_count)];
            put_piece(at, below(2) == 0 && word->size <= rest ? word->size : 0, word->bytes,
                      word->size < room ? word->size : 0);
            break;
        }
        /* fall through */
    case 4: /* one byte over and over */
        memset(piece, rest != 0 ? current->bytes[at] : (int)below(256), size);
        put_piece(at, 0, piece, size < room ? size : 0);
        break;
    case 5: /* a new byte */
        piece[0] = (uint8_t)random_u32();
        put_piece(at, 0, piece, room != 0);
        break;
    default:
        if (rest != 0) {
            mutate_byte(at);
        }
        break;
    }
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
    size_t pick = below(2) == 0 ? corpus_count - 1 - below(newest) : below(corpus_count);
    current->size = (uint32_t)corpus[pick].size;
    memcpy(current->bytes, corpus[pick].bytes, corpus[pick].size);
    for (size_t times = 1 + below(1 + ((size_t)1 << below(5))); times != 0; times--) {
        mutate_once(length_max);
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
    printf("%lu inputs, %u edges, %zu of the corpus count, %zu new\n", executions, reached, given,
           corpus_count - given);
}

static void share_current(void)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/corpus", work);
    (void)mkdir(path, 0777);
    snprintf(path, sizeof path, "%s/current", work);
    int file = open(path, O_RDWR | O_CREAT | O_TRUNC, 0666);
    if (file < 0 || ftruncate(file, sizeof *current) != 0) {
        stop("cannot make", path);
    }
    current = mmap(NULL, sizeof *current, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (current == MAP_FAILED) {
        stop("cannot map", path);
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

int main(int argc, char *argv[])
{
    double seconds = 0.0;
    size_t length_max = DEFAULT_LENGTH;
    const char *dictionary = NULL;
    int at = 1;
    random_state = 1;
    for (; at + 1 < argc && strncmp(argv[at], "--", 2) == 0; at += 2) {
        const char *value = argv[at + 1];
        if (strcmp(argv[at], "--seconds") == 0) {
            seconds = atof(value);
        } else if (strcmp(argv[at], "--seed") == 0) {
            random_state = strtoull(value, NULL, 10) * 2654435769u + 88172645463325252u;
        } else if (strcmp(argv[at], "--work") == 0) {
            work = value;
        } else if (strcmp(argv[at], "--dict") == 0) {
            dictionary = value;
        } else if (strcmp(argv[at], "--length") == 0) {
            length_max = strtoull(value, NULL, 10);
        } else {
            fprintf(stderr, "fuzz: unknown option %s\n", argv[at]);
            return 2;
        }
    }
    if (work == NULL) {
        return replay(argc - at, &argv[at]);
    }
    if (length_max > INPUT_MAX) {
        length_max = INPUT_MAX;
    }
    share_current();
    if (dictionary != NULL) {
        load_dictionary(dictionary);
    }
    for (; at < argc; at++) {
        load_folder(argv[at]);
    }
    fuzz(seconds, length_max);
    return 0;
}
