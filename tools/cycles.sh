#!/bin/sh
# cycles.sh: cycles of the sample path's parts on the simulated chip, as a table. Status 8 is how the program ends.
set -u
status=0
build/sim/simrun --fw build/uno/cycles.elf --in sim/streams/tilt-fast.csv --out build/sim/cycles.txt --max-ms 60000 2> build/sim/cycles.log || status=$?
if [ "$status" -ne 8 ]; then
    cat build/sim/cycles.log >&2
    exit 1
fi
awk 'BEGIN { printf "%-8s %8s %8s %8s   cycles per call, avr-gcc -Os\n", "", "least", "mean", "most" } { printf "%-8s %8d %8d %8d\n", $1, $2, $3, $4 }' build/sim/cycles.txt
