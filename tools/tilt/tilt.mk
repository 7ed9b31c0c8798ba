## tilt: install build/venv/bin/tilt, the command for recordings and boards (`build/venv/bin/tilt --help`)
tilt:
	@sh tools/deps.sh tilt
	@echo "tilt: build/venv/bin/tilt --help"

ROBUST_AND_PLAIN = $(wordlist 2,3,$(FILTERS_everyday))
## pictures: take the pictures of the pages again, from the firmware as it is (2 minutes; needs Chromium)
pictures: $(U)/firmware.elf $(S)/simrun
	@sh tools/deps.sh tilt
	@$(MAKE) sim OUT=$(S)/outliers.csv
	@cp $(S)/outliers.png docs/outliers.png
	@cd $(S) && for filter in $(ROBUST_AND_PLAIN); do ../venv/bin/tilt replay $(CURDIR)/sim/streams/steps-outliers.csv --filter $$filter -o $$filter.csv; done
	@cd $(S) && ../venv/bin/tilt plot $(ROBUST_AND_PLAIN:=.csv) --from 5 --to 20 --columns roll,flags,spectrum -o $(CURDIR)/docs/plot.png \
	    --title "$(subst $() , and ,$(ROBUST_AND_PLAIN:=.csv)): the same readings"
	@sh tools/deps.sh live
	@$(PY) host_tests/tools/tilt/live_picture.py
	@sh tools/deps.sh demo
	@$(MAKE) demo_built
	@$(PY) host_tests/tools/web/demo_picture.py

.PHONY: tilt pictures

# the sample path and all filters for `tilt replay`, `compare` and `tune`, which build it if it is missing or older than its sources; a new
# compiler's warnings must not break it: check-compile judges warnings
LIBTILT_SRC := $(wildcard host_tests/tools/libtilt/*.c) $(HOST_SRC) $(LAW_SUPPORT)
$(H)/libtilt.so: $(LIBTILT_SRC) $(wildcard host_tests/tools/libtilt/*.h host_tests/support/*.h */*.h lib/*/src/*.h hal/*/*.h) Makefile tools/tilt/tilt.mk
	@mkdir -p $(@D)
	@$(HOST_CC) $(filter-out -O1 -g,$(HOST_FLAGS)) -O2 -flto=auto -fPIC -shared -fvisibility=hidden $(filter-out -Werror,$(WARNINGS)) $(LIBTILT_SRC) -lm -o $@
