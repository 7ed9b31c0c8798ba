#!/bin/sh
# size.sh ELF [IMAGE [FLASH]]: prints flash and RAM of an image beside the budgets of checks/budgets.txt; over budget it lists the largest symbols
# with their files and fails (only with the compiler the budgets are for). The budgets of IMAGE are named IMAGE_flash_bytes and so on.
# FLASH: bytes that the board's boot loader leaves, if less than the UNO's.
set -eu
elf=$1
image=${2:+${2}_}
budget() {
    limit=$(awk -v name="$1" '$1 == name { print $2 }' checks/budgets.txt)
    [ -n "$limit" ] || { echo "size: checks/budgets.txt has no budget $1" >&2; exit 2; }
    echo "$limit"
}
flash_budget=$(budget "${image}flash_bytes")
board_flash=${3:-32256}
[ "$board_flash" -ge "$flash_budget" ] || flash_budget=$board_flash
ram_budget=$(budget "${image}ram_static_bytes")
data_budget=$(budget "${image}data_bytes")
# largest TYPES: the twelve largest symbols of these types of avr-nm, bytes, name and file
largest() {
    for at in $(avr-nm -S --size-sort "$elf" | awk -v types="$1" 'index(types, $3) { print $2 ":" $4 }' | tail -n 12); do
        name=${at#*:}
        source=$(grep -lE "\b${name%%.*}\b" firmware/*/*.c nav/*/*.c lib/*/src/*.c hal/avr/*.c | tr '\n' ' ')
        echo "    $((0x${at%%:*})) bytes: $name in ${source:-the libraries of the compiler}" >&2
    done
}
# shellcheck disable=SC2046
set -- $(avr-size -A "$elf" | awk '$1==".text"{t=$2} $1==".data"{d=$2} $1==".bss"{b=$2} $1==".noinit"{n=$2} END{print t+d, d+b+n, d+0}')
version=$(avr-gcc -dumpversion)
printf '%s: flash %d bytes (budget %d of %d), static RAM %d bytes (budget %d of 2048), .data %d bytes (budget %d), avr-gcc %s\n' \
    "$elf" "$1" "$flash_budget" "$board_flash" "$2" "$ram_budget" "$3" "$data_budget" "$version"
if [ "$1" -gt "$flash_budget" ] || [ "$2" -gt "$ram_budget" ] || [ "$3" -gt "$data_budget" ]; then
    if [ "$version" = 5.4.0 ]; then
        echo "size: over budget; the largest:" >&2
        [ "$1" -le "$flash_budget" ] || largest TtRr
        [ "$2" -le "$ram_budget" ] && [ "$3" -le "$data_budget" ] || largest BbDd
        exit 1
    fi
    echo "size: over budget, reported only: the budgets are for avr-gcc 5.4.0"
fi
