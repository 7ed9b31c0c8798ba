#!/usr/bin/env bash
# What CI has no time for, whole: every test, proof, campaign and measurement. Pages are judged as they are committed, before they are measured,
# and once more at the end, when only those that could not be measured here are stale. Each step's result goes into docs/results/nightly.md.
# STEPS="faults soak": only these.
set -u
cd "$(dirname "$0")/.." || exit 1
who=nightly
. campaigns/steps.sh || exit 1

wanted() {
    [ -z "${STEPS:-}" ] || [[ " $STEPS " == *" $1 "* ]]
}

after_step() {
    python3 campaigns/night_page.py "${NIGHT_PAGE:-docs/results/nightly.md}" "$@"
}

for name in ${STEPS:-}; do
    grep -qE "^(step|counted) $name( |\$)" campaigns/nightly.sh || { echo "nightly: STEPS names what is no step: $name" >&2; exit 1; }
done

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
step default
step robust
step synthesised
step structure
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
