#!/bin/sh
# run_tests.sh TEST...: runs each Unity program, the images of $CHIP_TESTS in the simulator and the system tests, shows what
# failed or was skipped, ends with the sum. The whole-firmware runs, a third of the time, go on beside the others.
set -u
log=build/host/tests.log
: > "$log"
broken=0

# tell_one NAME STATUS: what a program said and its last line, for the sum
tell_one() {
    name=$1
    status=$2
    cat "build/host/$name.log" >> "$log"
    line=$(grep -E '^[0-9]+ Tests [0-9]+ Failures [0-9]+ Ignored' "build/host/$name.log" | tail -n 1)
    echo "${line:-crashed (status $status)}"
    grep -E ':(FAIL|IGNORE)' "build/host/$name.log" | sed 's/^/    /'
    case $line in
        *" 0 Failures "*) [ "$status" -eq 0 ] || line= ;;
    esac
    if [ -z "$line" ]; then
        echo "    ended with status $status"
        broken=$((broken + 1))
        tail -n 12 "build/host/$name.log" | sed 's/^/    /'
    fi
}

run_one() {
    name=$1
    shift
    printf '%-28s' "$name"
    "$@" > "build/host/$name.log" 2>&1
    tell_one "$name" $?
}

python3 host_tests/system_tests.py > build/host/system_tests.log 2>&1 &
beside=$!
trap 'kill $beside 2> /dev/null' EXIT
trap 'exit 130' INT TERM

for test in "$@"; do
    run_one "$(basename "$test")" "$test"
done
run_one filter_sequence build/host/filter_sequence
for image in $CHIP_TESTS; do
    run_one "chip_$(basename "$image" .elf)" python3 host_tests/chip_test.py "$image"
done
run_one bitexact python3 tools/bitexact.py
run_one exhaustive_isqrt build/host/exhaustive_isqrt
run_one test_plot_run build/venv/bin/python host_tests/test_plot_run.py
run_one test_flash python3 host_tests/test_flash.py
run_one test_bench python3 host_tests/test_bench.py
run_one test_papers python3 host_tests/test_papers.py
run_one test_papers_synthesis python3 host_tests/test_papers_synthesis.py
run_one test_schedule python3 host_tests/test_schedule.py
run_one test_robust build/venv/bin/python host_tests/test_robust.py
run_one test_design build/venv/bin/python host_tests/test_design.py
run_one test_design_command build/venv/bin/python host_tests/test_design_command.py
run_one test_synthesised build/venv/bin/python host_tests/test_synthesised.py
run_one test_pages python3 host_tests/test_pages.py
run_one test_default python3 host_tests/test_default.py
printf '%-28s' system_tests
wait "$beside"
tell_one system_tests $?
awk -v broken="$broken" '/^[0-9]+ Tests [0-9]+ Failures [0-9]+ Ignored/ { t += $1; f += $3; s += $5 }
    END { f += broken; printf "skipped: %d (each with its reason above)\n%d passed, %d failed\n", s, t - (f - broken) - s, f; exit f != 0 }' "$log"
