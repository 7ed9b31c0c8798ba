#!/bin/sh
# proof.sh [PATTERN...]: Frama-C if it can be had, then campaigns/proof/proof.py. Without it a line that says so, counted, status 0.
# make passes its one pattern as PROOF_ONLY, by the environment, where a quote in it breaks no shell.
set -u
cd "$(dirname "$0")/../.." || exit 1
mkdir -p build
sh tools/deps.sh proof 2> build/proof-deps.log
if ! command -v frama-c > /dev/null 2>&1; then
    echo "skipped: make proof needs Frama-C (Debian package frama-c-base): $(head -n 1 build/proof-deps.log)"
    echo "skipped: 1"
    echo "0 passed, 0 failed"
    exit 0
fi
if [ "$#" -eq 0 ] && [ -n "${PROOF_ONLY:-}" ]; then
    set -- "$PROOF_ONLY"
fi
exec python3 campaigns/proof/proof.py "$@"
