# The synthesiser of the papers' filters: parameters, properties, pictures, configuration.

## design: synthesise a filter, ARGS="--rate 10 --sigma 3.4 --error 3 --at 100"; ARGS=--help lists all options
design:
	@sh tools/deps.sh design
	@$(PY) tools/design $(ARGS)

.PHONY: design
