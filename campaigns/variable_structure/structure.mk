# Paper 004's measurement system of variable structure: tables, numbers and picture of docs/results/variable-structure.md.

## structure: measure the numbers and draw the picture of docs/results/variable-structure.md (1 minute)
structure:
	@sh tools/deps.sh papers
	@$(PY) campaigns/pages/structure_page.py

.PHONY: structure
