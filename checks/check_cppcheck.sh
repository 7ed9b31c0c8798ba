#!/bin/sh
# check_cppcheck.sh [FILE...]: cppcheck, the chip's code with the AVR's sizes of types, the PC's with its own. Named files: only these.
set -eu
includes='-Ihal -Ifirmware -Inav/image -Ilib/machine/src -Ilib/filters/src -Ilib/tilt/src -Ilib/adxl345/src -Inav/lib'
command -v cppcheck > /dev/null || { echo 'check_cppcheck.sh: cppcheck is not installed: sh tools/deps.sh check' >&2; exit 2; }
# shellcheck disable=SC2086
cppcheck --platform=avr8 --std=c11 --enable=warning,style,performance,portability --error-exitcode=1 -q $includes -Ihal/avr ${*:-lib firmware nav/lib nav/image hal/avr}
[ $# -gt 0 ] ||
    # shellcheck disable=SC2086
    cppcheck --platform=unix64 --std=c11 --enable=warning,performance,portability --error-exitcode=1 -q $includes -Ihal/host -Isim/model -Isim/judge -Ihost_tests -Inav/tests \
        hal/host sim nav/tests/*.c host_tests/adxl345 host_tests/filters host_tests/firmware host_tests/hal host_tests/sim host_tests/support \
        host_tests/system host_tests/tilt host_tests/tools wokwi
echo 'cppcheck: clean'
