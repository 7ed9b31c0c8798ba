# Mutants by operators over lib, firmware and hal (campaigns/mutants).
MUTANTS_ENV = HOST_CC='$(HOST_CC)' HOST_CXX='$(HOST_CXX)' HOST_FLAGS='$(HOST_FLAGS)' HOST_SRC='$(HOST_SRC)' TESTS='$(TESTS)' UNITY_DIR='$(UNITY_DIR)' \
              NAV_VARIANTS='$(NAV_VARIANTS)' NAV_RINGS='$(NAV_RINGS)' $(foreach v,$(NAV_VARIANTS),NAV_OF_$(v)='$(NAV_OF_$(v))')

## mutants: change the product by operators and see that tests notice (hours, goes on where it stopped; ONLY=lib/tilt SAMPLE=25 STOP_AFTER=500 PATIENCE=3 ACCEPT=1)
mutants:
	@sh tools/deps.sh test
	@$(MUTANTS_ENV) python3 -B campaigns/mutants --only '$(ONLY)' --sample $(or $(SAMPLE),0) --seconds $(or $(STOP_AFTER),0) --patience $(or $(PATIENCE),0) $(if $(ACCEPT),--accept)

.PHONY: mutants
