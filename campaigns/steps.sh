# Targets of make one after another, for .ci/run and campaigns/nightly.sh, which set $who and end with `ended`. bash.
log=$(mktemp)
trap 'rm -f "$log"' EXIT
passed=0
failed=0
skipped=0
must_count=no
limit_s=0
steps=()

# what a script may have otherwise: which steps it takes, and what it does with a result (step, passed, failed, skipped, seconds)
wanted() { true; }
after_step() { true; }

# half over the budget of this step
over_budget() {
    [ "$limit_s" -gt 0 ] && [ $((2 * $1)) -gt $((3 * limit_s * ${SLOWER:-1})) ]
}

# the tests and failures that a step counts itself in its last line "N passed, N failed", else one for the step; a failed step is never 0
step() {
    wanted "$1" || return 0
    local began=$SECONDS took
    make "$@" 2>&1 | tee "$log"
    local status=${PIPESTATUS[0]}
    local good bad left_out
    read -r good bad < <(sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed.*/\1 \2/p' "$log" | tail -n 1)
    if [ "$status" -ne 0 ]; then
        echo "$who: make $* failed"
        : "${good:=0}"
        [ "${bad:-0}" -gt 0 ] || bad=1
    fi
    left_out=$(sed -n 's/^skipped: \([0-9]*\).*/\1/p' "$log" | tail -n 1)
    if [ "$must_count" = yes ] && [ "${bad:-0}" -eq 0 ] && [ $((${good:-0} + ${left_out:-0})) -eq 0 ]; then
        echo "$who: make $* failed: it prints nothing passed, failed or skipped"
        good=0
        bad=1
    fi
    took=$((SECONDS - began))
    if over_budget "$took"; then
        echo "$who: make $* failed: $took s are more than half over its budget of $limit_s s (SLOWER=2: a machine that takes twice as long)"
        bad=$((${bad:-0} + 1))
    fi
    passed=$((passed + ${good:-1}))
    failed=$((failed + ${bad:-0}))
    skipped=$((skipped + ${left_out:-0}))
    steps+=("make $*: $took s, ${bad:-0} failed")
    after_step "$*" "${good:-$((${bad:-0} == 0))}" "${bad:-0}" "${left_out:-0}" "$took"
    echo "$who: make $*: $took s$([ "$limit_s" -eq 0 ] || echo " of $limit_s s")"
}

# a step of which something must be heard: a status of 0 alone is no success
counted() {
    must_count=yes
    step "$@"
    must_count=no
}

# within MINUTES step|counted TARGET...: its budget on two cores; half over it is a failure
within() {
    limit_s=$(($1 * 60))
    shift
    "$@"
    limit_s=0
}

# the sums, and the status
ended() {
    echo "$who: $skipped skipped, $SECONDS s"
    echo "$passed passed, $failed failed"
    [ "$failed" -eq 0 ]
}
