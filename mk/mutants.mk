# Named breakages that the tests must catch.

## mutants: break the code in named places and see that the tests notice (10 minutes; SAMPLE=10: ten of them)
mutants:
	@sh tools/deps.sh test
	@python3 tools/mutants.py --sample $(or $(SAMPLE),0)

.PHONY: mutants
