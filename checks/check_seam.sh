#!/bin/sh
# check_seam.sh: the HAL costs nothing. The same I2C handler through the HAL's verbs and with the registers written out must
# give the same machine code at -Os.
set -eu
dir=build/check
mkdir -p "$dir"
for name in hal direct; do
    avr-gcc -std=gnu11 -mmcu=atmega328p -DF_CPU=16000000UL -Os -Ihal -Ihal/avr -Ilib/machine/src -Ihost_tests/chip -c "host_tests/chip/seam_$name.c" -o "$dir/seam_$name.o"
    avr-objdump -d "$dir/seam_$name.o" | sed 1,3d > "$dir/seam_$name.txt"
done
if cmp -s "$dir/seam_hal.txt" "$dir/seam_direct.txt"; then
    echo "HAL seam: same machine code ($(grep -c '^ ' "$dir/seam_hal.txt") instructions)"
else
    echo "HAL seam: a verb of hal/avr/hal_i2c_port.h costs something; registers written out (<) and verbs (>):" >&2
    diff "$dir/seam_direct.txt" "$dir/seam_hal.txt" >&2 || true
    version=$(avr-gcc -dumpversion)
    if [ "$version" = 5.4.0 ]; then
        exit 1
    fi
    echo "HAL seam: reported only, the promise is for avr-gcc 5.4.0 and this is $version"
fi
