# The nightly run: hours.

## nightly: run every test, proof, campaign and measurement in full, with times; stale pages fail (a night and more; STEPS='faults soak': only these)
nightly:
	@STEPS='$(STEPS)' bash campaigns/nightly.sh

.PHONY: nightly
