# Mutants of lib, firmware and hal: by operators (campaigns/mutants), and named breakages that no operator makes.
MUTANTS_ENV = HOST_CC='$(HOST_CC)' HOST_CXX='$(HOST_CXX)' HOST_FLAGS='$(HOST_FLAGS)' HOST_SRC='$(HOST_SRC)' TESTS='$(TESTS)' UNITY_DIR='$(UNITY_DIR)' \
              NAV_VARIANTS='$(NAV_VARIANTS)' NAV_RINGS='$(NAV_RINGS)' $(foreach v,$(NAV_VARIANTS),NAV_OF_$(v)='$(NAV_OF_$(v))')

## mutants: change the product by operators and check that tests notice, into docs/results/mutants.md (hours, continues where it stopped; ONLY=lib/tilt SAMPLE=25 STOP_AFTER=500 PATIENCE=3 ACCEPT=1; NAMED=yes: at the places of campaigns/breakages/breakages.txt, SAMPLE=6 ONLY='gate sign')
# $(call yes,NAME): whether a variable is yes; any other word than these stops make
yes = $(if $(filter-out yes no 1 0,$($(1))),$(error $(1)=$($(1)) is neither yes nor no))$(filter yes 1,$($(1)))
mutants: export MUTANTS_ONLY = $(value ONLY)
mutants: export MUTANTS_SAMPLE = $(value SAMPLE)
mutants: export MUTANTS_SECONDS = $(value STOP_AFTER)
mutants: export MUTANTS_PATIENCE = $(value PATIENCE)
MUTANTS_NAMED    = $(TEST_ENV) python3 campaigns/breakages/breakages.py --sample="$$MUTANTS_SAMPLE" $${MUTANTS_ONLY:+"$$MUTANTS_ONLY"}
MUTANTS_OPERATED = $(MUTANTS_ENV) python3 -B campaigns/mutants --only="$$MUTANTS_ONLY" --sample="$$MUTANTS_SAMPLE" \
                   --seconds="$$MUTANTS_SECONDS" --patience="$$MUTANTS_PATIENCE" $(if $(call yes,ACCEPT),--accept)
mutants:
	@sh tools/deps.sh test
	@$(if $(call yes,NAMED),$(MUTANTS_NAMED),$(MUTANTS_OPERATED))

.PHONY: mutants
