#!/bin/sh
# run_tests.sh TEST...: runs each Unity program and the system tests, shows what failed or was skipped, ends with the sum.
set -u
log=build/host/tests.log
: > "$log"
broken=0
for test in "$@"; do
    name=$(basename "$test")
    printf '%-28s' "$name"
    "$test" > "build/host/$name.log" 2>&1
    status=$?
    cat "build/host/$name.log" >> "$log"
    line=$(grep -E '^[0-9]+ Tests [0-9]+ Failures [0-9]+ Ignored' "build/host/$name.log" | tail -n 1)
    echo "${line:-crashed (status $status)}"
    grep -E ':(FAIL|IGNORE)' "build/host/$name.log" | sed 's/^/    /'
    if [ -z "$line" ]; then
        broken=$((broken + 1))
        tail -n 12 "build/host/$name.log" | sed 's/^/    /'
    fi
done
printf '%-28s' "system tests (simulator)"
python3 host_tests/system_tests.py > build/host/system.log 2>&1 || true
cat build/host/system.log >> "$log"
line=$(grep -E '^[0-9]+ Tests [0-9]+ Failures [0-9]+ Ignored' build/host/system.log | tail -n 1)
echo "${line:-crashed}"
grep -E ':(FAIL|IGNORE)' build/host/system.log | sed 's/^/    /'
if [ -z "$line" ]; then
    broken=$((broken + 1))
    tail -n 12 build/host/system.log | sed 's/^/    /'
fi
awk -v broken="$broken" '/^[0-9]+ Tests [0-9]+ Failures [0-9]+ Ignored/ { t += $1; f += $3; s += $5 }
    END { f += broken; printf "skipped: %d (each with its reason above)\n%d passed, %d failed\n", s, t - (f - broken) - s, f; exit f != 0 }' "$log"
