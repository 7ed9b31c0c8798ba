# What takes hours.

## nightly: every test, proof, campaign and measurement whole, each with its time; stale pages fail (a night and more: mutants and soak)
nightly:
	@bash campaigns/nightly.sh

.PHONY: nightly
