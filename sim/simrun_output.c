/* Files that simrun writes; errors on opening and closing name the path. */
#include <stdio.h>
#include <stdlib.h>

#include "simrun.h"

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
