/*
 * A test program on Unity: TEST(name) { ... } defines a test and lists it, so that none is forgotten. The main of
 * test.c runs all of a file, in the file's order; setUp and tearDown are written only where there is something to do.
 */
#ifndef SUPPORT_TEST_H
#define SUPPORT_TEST_H

#include <stddef.h>

#include "unity.h"

#ifndef TEST_TEXT /* on the chip chip/unity_chip.h has these: names are in program memory there */
#define TEST_TEXT(text) (text)
#define TEST_RUN UnityDefaultTestRun
#endif

typedef struct test {
    void (*run)(void);
    const char *file, *name;
    int line;
    struct test *next;
} test_t;

/* Enters a test in the list, which is sorted by line. */
void test_add(test_t *test);

/* Runs all tests: what a main of a test's own returns. */
int test_all(void);

#define TEST(function)                                                               \
    static void function(void);                                                      \
    __attribute__((constructor)) static void function##_is_listed(void)              \
    {                                                                                \
        static test_t test;                                                          \
        test = (test_t){ function, __FILE__, TEST_TEXT(#function), __LINE__, NULL }; \
        test_add(&test);                                                             \
    }                                                                                \
    static void function(void)

#endif
