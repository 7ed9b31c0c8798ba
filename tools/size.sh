#!/bin/sh
# size.sh ELF: flash and RAM of an image beside the budgets; fails over budget (only with the compiler the budgets are for).
set -eu
elf=$1
flash_budget=23040 ram_budget=1200 data_budget=64
# shellcheck disable=SC2046
set -- $(avr-size -A "$elf" | awk '$1==".text"{t=$2} $1==".data"{d=$2} $1==".bss"{b=$2} $1==".noinit"{n=$2} END{print t+d, d+b+n, d+0}')
version=$(avr-gcc -dumpversion)
printf 'flash %d bytes (budget %d of 32256), static RAM %d bytes (budget %d of 2048), .data %d bytes (budget %d), avr-gcc %s\n' \
    "$1" "$flash_budget" "$2" "$ram_budget" "$3" "$data_budget" "$version"
if [ "$1" -gt "$flash_budget" ] || [ "$2" -gt "$ram_budget" ] || [ "$3" -gt "$data_budget" ]; then
    if [ "$version" = 5.4.0 ]; then
        echo "size: over budget" >&2
        exit 1
    fi
    echo "size: over budget, reported only: the budgets are for avr-gcc 5.4.0"
fi
