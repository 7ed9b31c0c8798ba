/*
 * The integer square root over all 2^32 arguments: floor(sqrt(v)) is the r with r^2 <= v < (r + 1)^2. Two processes,
 * each one half; built without sanitizers, about half a minute. Prints a line in Unity's form for run_tests.py.
 */
#include <stdio.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tilt.h"

/* Exit status 1 names a wrong root on stderr. */
static int check_half(uint32_t first, uint32_t last)
{
    uint64_t root = 0;
    while ((root + 1) * (root + 1) <= first) {
        root++;
    }
    for (uint32_t v = first;; v++) {
        root += (root + 1) * (root + 1) <= v;
        if (tilt_isqrt32(v) != root) {
            fprintf(stderr, "tilt_isqrt32(%lu) is %u, not %lu\n", (unsigned long)v, tilt_isqrt32(v),
                    (unsigned long)root);
            return 1;
        }
        if (v == last) {
            return 0;
        }
    }
}

int main(void)
{
    pid_t child = fork();
    if (child < 0) {
        perror("fork");
        return 1;
    }
    if (child == 0) {
        _exit(check_half(0x80000000u, UINT32_MAX));
    }
    int failures = check_half(0, 0x7FFFFFFFu);
    int status = 1;
    waitpid(child, &status, 0);
    failures += !WIFEXITED(status) || WEXITSTATUS(status) != 0;
    printf("%s\n2 Tests %d Failures 0 Ignored\n", failures ? "exhaustive_isqrt:FAIL" : "exhaustive_isqrt:PASS",
           failures);
    return failures;
}
