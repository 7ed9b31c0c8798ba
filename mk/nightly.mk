# The nightly run: hours.

## nightly: run every test, proof, campaign and measurement in full, with times; stale pages fail (a night and more: mutants and soak)
nightly:
	@bash campaigns/nightly.sh

.PHONY: nightly
