# Named breakages that the tests must catch.

## mutants: break the code in named places and see that the tests notice (4 minutes)
mutants:
	@sh tools/deps.sh test
	@python3 tools/mutants.py

.PHONY: mutants
