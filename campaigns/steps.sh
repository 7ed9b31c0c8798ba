# Targets of make one after another, for .ci/run and campaigns/nightly.sh, which set $who and end with `ended`. bash.
log=$(mktemp)
trap 'rm -f "$log"' EXIT
passed=0
failed=0
skipped=0
must_count=no
steps=()

# the tests and failures that a step counts itself in its last line "N passed, N failed", else one for the step; a failed step is never 0
step() {
    local began=$SECONDS
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
    passed=$((passed + ${good:-1}))
    failed=$((failed + ${bad:-0}))
    skipped=$((skipped + ${left_out:-0}))
    steps+=("make $*: $((SECONDS - began)) s, ${bad:-0} failed")
    echo "$who: make $*: $((SECONDS - began)) s"
}

# a step of which something must be heard: a status of 0 alone is no success
counted() {
    must_count=yes
    step "$@"
    must_count=no
}

# the sums, and the status
ended() {
    echo "$who: $skipped skipped, $SECONDS s"
    echo "$passed passed, $failed failed"
    [ "$failed" -eq 0 ]
}
