#!/bin/sh
# check_format.sh [FILE...]: clang-format agrees with every C and C++ file, or with those named.
set -eu
command -v clang-format > /dev/null || { echo 'check_format.sh: clang-format is not installed: sh tools/deps.sh check' >&2; exit 2; }
# shellcheck disable=SC2046
clang-format --dry-run -Werror ${*:-$(find firmware nav lib hal sim host_tests \( -name '*.[ch]' -o -name '*.cpp' -o -name '*.hpp' \) | sort)}
echo 'format: clean'
