#include "unity.h"

enum { NAME_MAX = 80 };

void unity_chip_run(void (*test)(void), const char *flash_name, int line)
{
    static char name[NAME_MAX];
    strncpy_P(name, flash_name, NAME_MAX - 1);
    UnityDefaultTestRun(test, name, line);
}
