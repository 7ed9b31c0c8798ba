#!/usr/bin/env bash
# What CI has no time for, whole: every test, proof, campaign and measurement. Pages are judged as they are committed, before they are measured,
# and once more at the end, when only those that could not be measured here are stale.
set -u
cd "$(dirname "$0")/.." || exit 1
who=nightly
. campaigns/steps.sh || exit 1

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
