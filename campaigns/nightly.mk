# What takes hours.

## nightly: every test, proof, campaign and measurement whole, each with its time; stale pages fail (a night and more; STEPS='faults soak': only these)
nightly:
	@STEPS='$(STEPS)' bash campaigns/nightly.sh

.PHONY: nightly
