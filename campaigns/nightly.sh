#!/usr/bin/env bash
# What CI has no time for, whole: every test, proof, campaign and measurement. Pages are judged as they are committed, before they are measured,
# and once more at the end, when only those that could not be measured here are stale. Each step's result goes into docs/results/nightly.md.
# STEPS="faults soak": only these.
set -u
cd "$(dirname "$0")/.." || exit 1
who=nightly
. campaigns/steps.sh || exit 1

# variables of the command line and the environment must not make a step smaller
unset MAKEFLAGS MAKEOVERRIDES MFLAGS SAMPLE ONLY RUNS PAPER_SEED CHANGED BREAKAGES PLANTED PART PROFILES PATIENCE STOP_AFTER RECORDINGS
only=${STEPS:-}
unset STEPS
judged=''

# with a + when something that counts is not committed
commit_now() {
    local found
    found=$(git rev-parse --short=8 HEAD 2> /dev/null) || { echo 'no git'; return; }
    [ -z "$(git status --porcelain -- . ':!docs/results')" ] || found+=+
    echo "$found"
}

wanted() {
    [ -z "$only" ] || [[ " $only " == *" $1 "* ]] || return 1
    judged=$(commit_now)
}

after_step() {
    python3 campaigns/night_page.py "${NIGHT_PAGE:-docs/results/nightly.md}" "$judged" "$@"
}

names=$(sed -nE 's/^(step|counted) ([a-z-]+).*/\2/p' campaigns/nightly.sh | sort -u)
for name in $only; do
    grep -qxF -- "$name" <<< "$names" || { echo "nightly: STEPS: no step $name; choose from: $(echo $names)" >&2; exit 1; }
done
# a whole night judges every mutant again; `make nightly STEPS=mutants` and `make mutants` go on where they were stopped
[ -n "$only" ] || rm -f build/mutants/results.jsonl

step check-pages STRICT=yes
counted test
step check
counted second
step bitexact
step arduino
step piocheck
counted proof
counted coverage
counted fuzz SECONDS=600
step bench
step papers
step papers PAPER_SEED=2025
step figures
step default
step comparison
step robust
step synthesised
counted recordings
step navcheck
counted faults
counted soak HOURS=24
counted race
counted loaded
counted mutants NAMED=yes
counted mutants
step check-pages STRICT=yes
printf 'nightly: %s\n' "${steps[@]}"
ended
