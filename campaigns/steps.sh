# Targets of make one after another, for .ci/run and campaigns/nightly.sh, which set $who and end with `ended`. bash.
# pyenv's python3 is a script that takes longer to start than Python itself
python=$(python3 -c 'import sys; print(sys.executable)' 2> /dev/null)
if [ -x "$python" ] && ! [ "$python" -ef "$(command -v python3)" ]; then
    PATH=${python%/*}:$PATH
fi

log=$(mktemp)
trap 'rm -f "$log"' EXIT
passed=0
failed=0
skipped=0
must_count=no
limit_s=0
all_limits_s=0
steps=()

if ! [[ ${SLOWER:-1} =~ ^[1-9][0-9]?$ ]]; then
    echo "$who: SLOWER=$SLOWER: how many times as long this machine takes, a whole number from 1 to 99" >&2
    exit 1
fi

# hooks that a script may replace: whether to take a step, what to do with its result (step, passed, failed, skipped, seconds), and the clock
wanted() { true; }
after_step() { true; }
elapsed() { echo $((SECONDS - $1)); }

# half over the budget of this step
over_budget() {
    [ "$limit_s" -gt 0 ] && [ $((2 * $1)) -gt $((3 * limit_s * ${SLOWER:-1})) ]
}

# Counts the tests and failures that a step reports in its last line "N passed, N failed"; without that line, one for the step, or none where
# it reports what it skipped. A failed step is never 0.
step() {
    wanted "$1" || return 0
    local began=$SECONDS took
    make "$@" 2>&1 | tee "$log"
    local status=${PIPESTATUS[0]}
    local good bad left_out
    read -r good bad < <(sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed.*/\1 \2/p' "$log" | tail -n 1)
    left_out=$(sed -n 's/^skipped: \([0-9]*\).*/\1/p' "$log" | tail -n 1)
    : "${left_out:=0}" "${bad:=0}"
    if [ "$status" -ne 0 ]; then
        echo "$who: make $* failed"
        : "${good:=0}"
        [ "$bad" -gt 0 ] || bad=1
    fi
    if [ "$must_count" = yes ] && [ "$bad" -eq 0 ] && [ $((${good:-0} + left_out)) -eq 0 ]; then
        echo "$who: make $* failed: it prints nothing passed, failed or skipped"
        good=0
        bad=1
    fi
    : "${good:=$((left_out == 0))}"
    took=$(elapsed "$began")
    if over_budget "$took"; then
        echo "$who: make $* failed: $took s are more than half over its budget of $limit_s s (SLOWER=2: a machine that takes twice as long)"
        bad=$((bad + 1))
    fi
    passed=$((passed + good))
    failed=$((failed + bad))
    skipped=$((skipped + left_out))
    steps+=("make $*: $took s, $bad failed")
    after_step "$*" "$good" "$bad" "$left_out" "$took"
    echo "$who: make $*: $took s$([ "$limit_s" -eq 0 ] || echo " of $limit_s s")"
}

# a step that must report a count: a status of 0 alone is no success
counted() {
    must_count=yes
    step "$@"
    must_count=no
}

# within MINUTES step|counted TARGET...: its budget on two cores; half over it is a failure
within() {
    limit_s=$(($1 * 60))
    all_limits_s=$((all_limits_s + limit_s))
    shift
    "$@"
    limit_s=0
}

# the sums, and the status
ended() {
    [ ${#steps[@]} -gt 0 ] || { echo "$who: no step was taken"; failed=1; }
    echo "$who: $skipped skipped, $SECONDS s$([ "$all_limits_s" -eq 0 ] || echo " of $all_limits_s s")"
    echo "$passed passed, $failed failed"
    [ "$failed" -eq 0 ]
}
