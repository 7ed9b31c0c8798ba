#!/bin/sh
# check_symbols.sh ELF: no float, 64-bit arithmetic, heap or printf in the firmware.
set -eu
forbidden='__(add|sub|mul|div|cmp|eq|ne|lt|le|gt|ge|neg|float|fix|fixuns|floatun)[a-z]*[sd]f[0-9a-z]*$|__[a-z]*di3$|__[a-z]*di2$|^(malloc|free|calloc|realloc|s?n?printf|vfprintf|sprintf)$'
found=$(avr-nm "$1" | awk '{print $3}' | grep -E "$forbidden" || true)
if [ -n "$found" ]; then
    echo "forbidden symbols in $1:" >&2
    echo "$found" >&2
    exit 1
fi
echo "forbidden symbols: none"
