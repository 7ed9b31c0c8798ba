# Which filter should be the default: decided by a table.

DEFAULT_SRC := host_tests/default_filter.c $(filter-out %/support_rig.c %/support_talk.c,$(wildcard host_tests/support_*.c)) $(HOST_SRC)
$(H)/default_filter: $(DEFAULT_SRC) $(wildcard */*.h lib/*/src/*.h hal/*/*.h)
	@mkdir -p $(@D)
	@$(HOST_CC) $(HOST_FLAGS) -O2 $(WARNINGS) $(DEFAULT_SRC) -lm -o $@

## default: which filter should be the default, into docs/default-filter.md (RECORDINGS=folder, else ../shared/streams; 2 minutes)
default:
	@sh tools/deps.sh test
	@$(MAKE) -s $(H)/default_filter
	@python3 tools/default_filter.py

.PHONY: default
