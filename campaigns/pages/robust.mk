# The robust filters compared: tables and pictures of docs/results/robust-filters.md.

## robust: run every filter over the shipped streams, into docs/results/robust-filters.md (10 seconds)
robust:
	@sh tools/deps.sh sim
	@$(MAKE) -s $(H)/pipeline_replay
	@$(PY) campaigns/pages/robust.py

.PHONY: robust
