/* Files that simrun writes: each opened and closed with the path in the complaint. */
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
