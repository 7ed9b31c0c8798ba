# The synthesised family: closed forms, adaptive's numbers and pictures of docs/synthesised-filters.md.

ROLL_SRC := host_tests/roll_replay.c $(wildcard lib/filters/src/*.c)
$(H)/roll_replay: $(ROLL_SRC) $(wildcard lib/filters/src/*.h)
	@mkdir -p $(@D)
	@$(HOST_CC) $(HOST_FLAGS) -O2 $(WARNINGS) $(ROLL_SRC) -lm -o $@

## synthesised: the numbers and pictures of docs/synthesised-filters.md (1 minute)
synthesised:
	@sh tools/deps.sh test
	@sh tools/deps.sh design
	@$(MAKE) -s $(H)/roll_replay $(H)/test_adaptive_roll
	@$(PY) tools/synthesised.py

.PHONY: synthesised
