#!/bin/sh
# sim.sh check STREAM OUT: checks that they can be read and written, and RATE, if it was typed, before anything is built.
# sim.sh IMAGE STREAM FILTER RATE OUT: one run of the firmware in the simulator, its summary and its picture.
set -eu
if [ "$1" = check ]; then
    stream=$2 folder=$(dirname "$3")
    mkdir -p build/sim
    if [ ! -r "$stream" ] || [ -d "$stream" ]; then
        echo "sim: cannot read the stream $stream: give STREAM=file.csv; shipped ones are in sim/streams" >&2
        exit 2
    fi
    if [ ! -d "$folder" ]; then
        echo "sim: no folder $folder for OUT=$3: mkdir -p $folder" >&2
        exit 2
    fi
    if [ -d "$3" ]; then
        echo "sim: OUT=$3 is a folder: give a file in it, such as OUT=${3%/}/run.csv" >&2
        exit 2
    fi
    case ${RATE-100} in
        12.5 | 25 | 50 | 100 | 200 | 400 | 800) exit 0 ;;
    esac
    echo "sim: RATE=$RATE: choose from 12.5 25 50 100 200 400 800" >&2
    exit 2
fi
image=$1 stream=$2 filter=$3 rate=$4 out=$5
base=${out%.csv}
base=${base%.out}
# 100 Hz rows fit 115200 baud; higher rates need a faster line
baud_option=
case $rate in
    200 | 400) baud_option='--baud 500000' ;;
    800) baud_option='--baud 500000 --every 4' ;;
esac
# shellcheck disable=SC2086
build/sim/simrun --fw "$image" --in "$stream" --out "$out" --filter "$filter" --rate "$rate" $baud_option \
    --served "$base.served.csv" --stats build/sim/stats.json
build/venv/bin/python tools/plot_run.py --run "$out" --stream "$stream" --stats build/sim/stats.json --served "$base.served.csv" \
    --png "$base.png" --title "$(basename "$stream" .csv), filter $filter, $rate Hz"
