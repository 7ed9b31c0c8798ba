# Mutants of lib, firmware and hal: by operators (campaigns/mutants), and named breakages that no operator makes.
MUTANTS_ENV = HOST_CC='$(HOST_CC)' HOST_CXX='$(HOST_CXX)' HOST_FLAGS='$(HOST_FLAGS)' HOST_SRC='$(HOST_SRC)' TESTS='$(TESTS)' UNITY_DIR='$(UNITY_DIR)' \
              NAV_VARIANTS='$(NAV_VARIANTS)' NAV_RINGS='$(NAV_RINGS)' $(foreach v,$(NAV_VARIANTS),NAV_OF_$(v)='$(NAV_OF_$(v))')

## mutants: change the product by operators and see that tests notice (hours, goes on where it stopped; ONLY=lib/tilt SAMPLE=25 STOP_AFTER=500 PATIENCE=3 ACCEPT=1; NAMED=yes: in the places of campaigns/breakages.txt, SAMPLE=6 ONLY='gate sign')
mutants: export MUTANTS_ONLY = $(value ONLY)
ifdef NAMED
mutants:
	@sh tools/deps.sh test
	@$(TEST_ENV) python3 campaigns/breakages.py --sample $(or $(SAMPLE),0) $${MUTANTS_ONLY:+"$$MUTANTS_ONLY"}
else
mutants:
	@sh tools/deps.sh test
	@$(MUTANTS_ENV) python3 -B campaigns/mutants --only "$$MUTANTS_ONLY" --sample $(or $(SAMPLE),0) --seconds $(or $(STOP_AFTER),0) --patience $(or $(PATIENCE),0) $(if $(ACCEPT),--accept)
endif

.PHONY: mutants
