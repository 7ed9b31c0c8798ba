# Which filter should be the default: decided by a table.

## default: decide which filter should be the default, into docs/results/default-filter.md (RECORDINGS=folder, else ../shared/streams; 2 minutes)
default:
	@sh tools/deps.sh test
	@$(MAKE) -s $(H)/default_filter
	@python3 campaigns/pages/default_filter.py

.PHONY: default
