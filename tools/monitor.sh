#!/bin/sh
# monitor.sh PORT BAUD: show what the board sends and type commands, with what every Debian has. Ctrl-C ends.
set -eu
port=$1 baud=$2
if [ ! -c "$port" ]; then
    echo "monitor: no serial port $port: plug the board in, or say make monitor PORT=/dev/ttyUSB0" >&2
    exit 1
fi
stty -F "$port" "$baud" raw -echo -hupcl
cat "$port" &
reader=$!
trap 'kill "$reader" 2>/dev/null' EXIT INT TERM
echo "monitor: $port at $baud baud; type help and Enter, Ctrl-C ends"
while IFS= read -r line; do
    printf '%s\n' "$line" > "$port"
done
