#include "simrun_output.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>

void output_refuse(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("simrun: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    exit(EXIT_INPUT);
}

FILE *output_open(const char *path)
{
    FILE *file = fopen(path, "wb");
    if (file == NULL) {
        perror(path);
        exit(EXIT_INPUT);
    }
    return file;
}

void output_close(FILE *file, const char *path)
{
    if (file == NULL) {
        return;
    }
    bool failed = ferror(file) != 0;
    if (fclose(file) != 0 || failed) {
        perror(path);
        exit(EXIT_INTERNAL);
    }
}
