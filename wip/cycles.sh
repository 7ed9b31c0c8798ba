# run.sh old|new LAW [extra]
W=$1; L=$2; X=$3; FL=${FL:-"-Os -mstrict-X"}
if [ $W = new ]; then I=/work/laws/lib/filters/src; D=-DNEW; SRC=$(ls $I/*.c | grep -v filter_list.c); else I=/work/oldlib; D=; SRC=$(ls $I/*.c | grep -v filter_any); fi
E=/tmp/cyc_$W$L.elf
avr-gcc -std=gnu11 -mmcu=atmega328p -DF_CPU=16000000UL $FL $D -DLAW=$L $X -ffunction-sections -fdata-sections -Wl,--gc-sections -I$I b.c $SRC -o $E || exit 1
/work/main/build/sim/simrun --fw $E --in /work/main/sim/streams/tilt-fast.csv --out /tmp/cyc_$W$L.txt --max-ms 300000 >/dev/null 2>/tmp/cyc_err; s=$(tail -1 /tmp/cyc_$W$L.txt); echo "$W $L $X: $s ($(avr-size $E | tail -1 | awk '{print $1}') B)"
