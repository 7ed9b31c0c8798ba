#!/bin/sh
# check_format.sh: clang-format agrees with every C and C++ file.
set -eu
# shellcheck disable=SC2046
clang-format --dry-run -Werror $(find firmware lib hal sim host_tests -name '*.[ch]' -o -name '*.cpp' | sort)
echo "format: clean"
