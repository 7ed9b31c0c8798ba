# Coverage of lib by the unit tests (gcov; built apart, without sanitizers) and of the AVR binary by the system tests.
C := $(B)/coverage
# the supervision of sensor and stages is judged beside lib, and the navigation image's link (campaigns/coverage/nav_lib_coverage.mk)
SUPERVISION   := $(wildcard $(addprefix firmware/*/,sensor_watch.c health.c pipeline.c coast.c gravity.c supervisor.c))
# without tests that run the same lines as others, only more often: they took two thirds of the time and added no line or branch. When one of
# them runs a line that is reported, take that test off the list.
COVERAGE_SAME  := %_reference test_recording_faults test_recordings test_adaptive_roll test_streams_shipped test_filter_bursts test_tilt_filter \
                  test_nav_covariance test_nav_flight test_wokwi
COVERAGE_SRC   := $(foreach t,$(TEST_SRC),$(if $(filter $(COVERAGE_SAME),$(basename $(notdir $(t)))),,$(t)))
COVERAGE_TESTS := $(addprefix $(C)/,$(basename $(notdir $(COVERAGE_SRC))))

# unoptimised, so that a line is a line; the tests too, for what they inline from the headers of lib; gcovr keeps what is judged
COVERAGE_FLAGS := -O1
$(C)/lib/%.o $(SUPERVISION:%.c=$(C)/%.o) $(COVERAGE_SRC:%.c=$(C)/%.o): COVERAGE_FLAGS := -O0 --coverage

$(C)/%.o: %.c Makefile campaigns/coverage/coverage.mk
	@mkdir -p $(@D)
	@$(HOST_CC) $(HOST_FLAGS) $(COVERAGE_FLAGS) -MMD -MP -c $< -o $@

# the references are not judged: those of make test, which hold the sanitizer of undefined behaviour
COVERAGE_REFERENCES := $(patsubst %.cpp,$(C)/%.o,$(wildcard host_tests/reference/*.cpp nav/tests/*.cpp))
$(COVERAGE_REFERENCES): $(C)/%.o: $(H)/%.o
	@mkdir -p $(@D)
	@cp $< $@

$(C)/unity.o: $(UNITY_DIR)/unity.c
	@mkdir -p $(@D)
	@$(HOST_CC) -std=c11 -O1 -DUNITY_INCLUDE_DOUBLE -c $< -o $@

# what each is linked with is in parts.mk, as for make test
$(foreach t,$(filter-out %/test_nav_link.c,$(COVERAGE_SRC)),$(eval $(C)/$(basename $(notdir $(t))): $(C)/$(t:.c=.o)))
$(filter-out %/test_nav_link,$(COVERAGE_TESTS)): $(C)/unity.o $(C)/libsupport.a
	@$(HOST_CXX) --coverage -fsanitize=undefined $(call linked,$^) -lm -o $@

$(C)/host.json: $(COVERAGE_TESTS)
	@find $(C) -name '*.gcda' -delete
	@printf '%s\n' $(COVERAGE_TESTS) | xargs -P 2 -I TEST sh -c \
	    'timeout 900 TEST > TEST.log 2>&1 || { echo "coverage: TEST failed:"; grep :FAIL TEST.log; exit 255; }'
	@mkdir -p $(C)/html
	@gcovr --root . --object-directory $(C) --filter '$(CURDIR)/lib/' --filter '$(CURDIR)/nav/image/' --filter '$(CURDIR)/nav/lib/' $(SUPERVISION:%=--filter '$(CURDIR)/%') --exclude-unreachable-branches --json $@ \
	    --html-details $(C)/html/index.html $(C) > $(C)/gcovr.log 2>&1 || { cat $(C)/gcovr.log; exit 1; }

$(C)/probe.elf: host_tests/chip/coverage_probe.c Makefile
	@mkdir -p $(@D)
	@$(AVR_CC) -std=gnu11 -mmcu=atmega328p -Os -flto -gdwarf-2 $(WARNINGS) $< -o $@

# status 8: the program ends asleep with interrupts off
$(C)/probe.prof: $(C)/probe.elf $(S)/simrun
	@$(S)/simrun --fw $< --in sim/streams/tilt-fast.csv --out $(C)/probe.txt --profile $@ --max-ms 100 2> $(C)/probe.log; \
	    test $$? -eq 8 || { cat $(C)/probe.log; exit 1; }

# Runs of the system tests, unless PROFILES says where they have left theirs already. The minutes in which nothing is lost are left out: they run
# hardly any line that the others do not. Two halves side by side.
COVERAGE_RUNS := $(if $(PROFILES),,$(C)/runs/equal $(C)/runs/rest)
$(C)/runs/equal: RUNS_OF := chip_equals
$(C)/runs/rest: RUNS_OF := -chip_equals -nothing_lost
$(C)/runs/equal $(C)/runs/rest: system_images
	@rm -rf $@ && mkdir -p $@
	@PROFILES=$@ python3 host_tests/system/system_tests.py $(RUNS_OF) > $(C)/system_$(@F).log 2>&1 || \
	    { grep ':FAIL' $(C)/system_$(@F).log; exit 1; }

## coverage: measure lines and branches of lib in the unit tests, lines of the AVR binary in the system tests (5 minutes; 1 after PROFILES=folder make test, with the same PROFILES)
coverage: RUNS := $(or $(PROFILES),$(C)/runs)
coverage:
	@sh tools/deps.sh coverage
	@$(MAKE) -j2 $(COVERAGE_RUNS) $(C)/host.json $(C)/probe.prof
	@python3 campaigns/coverage/coverage.py check $(C)/probe.elf $(C)/probe.prof host_tests/chip/coverage_probe.c
	@python3 campaigns/coverage/coverage.py twins $(C)/host.json $(U)/firmware.elf $(RUNS)
	@python3 campaigns/coverage/coverage.py judge $(C)/host.json $(U)/firmware.elf $(RUNS)

clean: clean_coverage
clean_coverage:
	@rm -rf $(C)

.PHONY: coverage clean_coverage $(C)/runs/equal $(C)/runs/rest

-include $(shell find $(C) -name '*.d' 2>/dev/null)
