#!/bin/sh
# check_cpp_headers.sh: an Arduino sketch (gnu++11) can include every library header.
set -eu
dir=build/check
mkdir -p "$dir"
for folder in lib/filters/src lib/tilt/src; do
    for header in "$folder"/*.h; do
        echo "#include \"$(basename "$header")\"" > "$dir/header.cpp"
        avr-g++ -std=gnu++11 -mmcu=atmega328p -DF_CPU=16000000UL -Os -Wall -Wextra -Werror -Ilib/filters/src -Ilib/tilt/src -c "$dir/header.cpp" -o "$dir/header.o"
    done
done
echo "library headers: compile as gnu++11"
