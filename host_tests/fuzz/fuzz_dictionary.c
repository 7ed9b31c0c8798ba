/* Words that inputs are made of, from a file as libFuzzer takes it. */
#include <stdio.h>
#include <string.h>

#include "fuzz_drive.h"

enum { WORDS_MAX = 256, LINE_SIZE = 256 };

static blob_t word[WORDS_MAX];
static size_t word_count;

/* The text up to its end with each \xNN made a byte. */
static blob_t unescaped(const char *text)
{
    uint8_t bytes[LINE_SIZE];
    size_t size = 0;
    while (*text != '\0') {
        unsigned value = (uint8_t)*text;
        if (text[0] == '\\' && text[1] == 'x' && sscanf(text + 2, "%2x", &value) == 1) {
            text += 3;
        }
        text++;
        bytes[size++] = (uint8_t)value;
    }
    return fuzz_kept(bytes, size);
}

void dictionary_load(const char *path)
{
    char line[LINE_SIZE];
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        fuzz_stop("cannot open", path);
    }
    while (fgets(line, sizeof line, file) != NULL && word_count < WORDS_MAX) {
        char *end = strrchr(line, '"');
        if (line[0] == '"' && end != line) {
            *end = '\0';
            word[word_count++] = unescaped(line + 1);
        }
    }
    fclose(file);
}

const blob_t *dictionary_word(void)
{
    return word_count == 0 ? NULL : &word[mutate_below(word_count)];
}
