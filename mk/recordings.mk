# The filters on real recordings, which are not part of this repository.

RECORDINGS_SRC := host_tests/recordings.c $(filter-out %/support_rig.c %/support_talk.c,$(wildcard host_tests/support_*.c)) $(HOST_SRC)
$(H)/recordings: $(RECORDINGS_SRC) $(wildcard */*.h lib/*/src/*.h hal/*/*.h)
	@mkdir -p $(@D)
	@$(HOST_CC) $(HOST_FLAGS) -O2 $(WARNINGS) $(RECORDINGS_SRC) -lm -o $@

## recordings: the filters on real recordings (RECORDINGS=folder, else ../shared/streams), into docs/recordings.md (2 minutes)
recordings:
	@sh tools/deps.sh test
	@$(MAKE) $(H)/recordings
	@python3 tools/recordings.py

.PHONY: recordings
