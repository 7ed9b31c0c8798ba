# Proof with Frama-C's Eva, 16-bit int, that the filters cannot overflow and stay within their bounds (host_tests/proof).

## proof: prove the filters free of overflow and within their bounds (Frama-C; ONLY='^soft_': those that match a regular expression; BREAKAGES=10: ten of the breakages; CHANGED=yes: those changed since the last proof)
proof: export PROOF_ONLY = $(value ONLY)
proof: export BREAKAGES := $(BREAKAGES)
proof: export CHANGED := $(CHANGED)
proof:
	@sh campaigns/proof/proof.sh

.PHONY: proof
