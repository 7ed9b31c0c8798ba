# Proof with Frama-C's Eva, 16-bit int, that the filters cannot overflow and stay within their bounds (host_tests/proof).

## proof: prove the filters free of overflow and within their bounds (Frama-C; ONLY='^soft_': what a regular expression finds; BREAKAGES=10: ten of the breakages; CHANGED=yes: what is not as it was when it was proved last)
proof: export PROOF_ONLY = $(value ONLY)
proof: export BREAKAGES := $(BREAKAGES)
proof: export CHANGED := $(CHANGED)
proof:
	@sh campaigns/proof/proof.sh

.PHONY: proof
