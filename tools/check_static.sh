#!/bin/sh
# check_static.sh: clang-tidy with the AVR target (16-bit int) and cppcheck over the portable code. The AVR's own headers defeat
# clang 14, so the host's side of the HAL stands in for them.
set -eu
includes='-Ihal -Ihal/host -Ilib/filters/src -Ilib/tilt/src -Ilib/adxl345/src -Ifirmware'
# shellcheck disable=SC2086
clang-tidy -quiet lib/*/src/*.c firmware/*.c -- --target=avr -mmcu=atmega328p -std=c11 -isystem /usr/lib/avr/include $includes 2>/dev/null
# shellcheck disable=SC2086
cppcheck --platform=avr8 --std=c11 --enable=warning,portability --error-exitcode=1 -q $includes lib firmware
echo "clang-tidy (AVR target) and cppcheck: clean"
