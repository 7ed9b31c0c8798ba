SMALL="$1"; LAWS="$2"; cd /work/laws/lib/filters/src
avr-gcc -std=gnu11 -mmcu=atmega328p -DF_CPU=16000000UL $SMALL -ffunction-sections -fdata-sections -I. "-DLAWS=$LAWS" -Wl,--gc-sections ${M:-/tmp/m2.c} $(ls *.c | grep -v filter_list) -o /tmp/m.elf && avr-size /tmp/m.elf | tail -1; avr-nm -S /tmp/m.elf | grep checksize
