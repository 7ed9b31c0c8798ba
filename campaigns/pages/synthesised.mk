# The synthesised family: closed forms, adaptive's numbers and pictures of docs/results/synthesised-filters.md.

## synthesised: measure the numbers and draw the pictures of docs/results/synthesised-filters.md (1 minute)
synthesised:
	@sh tools/deps.sh test
	@sh tools/deps.sh design papers
	@$(MAKE) -s $(BATCH) $(H)/test_adaptive_roll
	@$(PY) campaigns/pages/synthesised.py

.PHONY: synthesised
