#include "support/test.h"

static test_t *first_test;

void test_add(test_t *test)
{
    test_t **at = &first_test;
    while (*at != NULL && (*at)->line < test->line) {
        at = &(*at)->next;
    }
    test->next = *at;
    *at = test;
}

int test_all(void)
{
    UnityBegin((first_test != NULL) ? first_test->file : "no test");
    for (const test_t *test = first_test; test != NULL; test = test->next) {
        Unity.TestFile = test->file;
        TEST_RUN(test->run, test->name, test->line);
    }
    return UnityEnd();
}

/* The test program's own, if it has one. */
__attribute__((weak)) void setUp(void) {}

__attribute__((weak)) void tearDown(void) {}

__attribute__((weak)) int main(void)
{
    return test_all();
}
