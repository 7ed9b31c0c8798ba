# Named breakages of the product that the tests must catch (campaigns/breakages.txt).

## breakages: break the product in named places and see that the tests notice (SAMPLE=6: six of them; ONLY='gate sign': by name)
breakages: export BREAKAGES_ONLY = $(value ONLY)
breakages:
	@sh tools/deps.sh test
	@python3 campaigns/breakages.py --sample $(or $(SAMPLE),0) $${BREAKAGES_ONLY:+"$$BREAKAGES_ONLY"}

.PHONY: breakages
