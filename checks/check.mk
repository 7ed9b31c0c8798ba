# The rules of the tree, enforced. Each check is a target of its own (make check-tidy ONLY=firmware/app/app.c checks one file); limits are in
# checks/budgets.txt, deviations from the rules in docs/deviations.md, and checks/planted.txt holds faults that the checks must find.
CHK := $(B)/check
ONLY ?=

# objects before link-time optimisation: only they show which file holds what. Warnings are not errors here, because avr-gcc warns that
# naked functions have no stack usage; check-compile finds real ones.
CHECK_OBJ := $(AVR_SRC:%.c=$(CHK)/avr/%.o)
$(CHK)/avr/%.o: %.c Makefile checks/check.mk
	@mkdir -p $(@D)
	@$(AVR_CC) $(filter-out -flto -Werror,$(AVR_FLAGS)) -fstack-usage -MMD -MP -c $< -o $@ 2> $@.log || { cat $@.log >&2; exit 1; }

# the longest first: two run at a time, each prints when it has ended, and all run whatever one finds
CHECKS := cppcheck compile tidy int16 includes circles format lengths names symbols memory frames painted waits size seam deviations breakages texts pages

## check: check every rule of the tree, and that each finds its planted faults (5 minutes; PLANTED=20: a sample of them)
check:
	@sh tools/deps.sh check
	@$(MAKE) -j2 check-built
	@$(MAKE) -k -j2 -O $(CHECKS:%=check-%) || { echo 'check: failed: the lines with *** above name the checks that found something' >&2; exit 1; }
	@$(MAKE) check-planted

check-built: check-objects $(U)/firmware.elf $(S)/simrun
	@:

# remove objects of deleted files, which would still be judged
check-objects: $(CHECK_OBJ)
	@find $(CHK)/avr -name '*.o' 2>/dev/null | while read -r o; do s=$${o#$(CHK)/avr/}; [ -f "$${s%.o}.c" ] || rm -f "$$o" "$${o%.o}.su"; done

check-compile:
	@WARNINGS="$(WARNINGS)" UNITY_DIR="$(UNITY_DIR)" python3 checks/check_compile.py $(ONLY)

check-tidy:
	@python3 checks/check_tidy.py $(ONLY)

check-int16:
	@python3 checks/check_int16.py $(ONLY)

check-cppcheck:
	@sh checks/check_cppcheck.sh $(ONLY)

check-includes:
	@python3 checks/check_includes.py

# the PC's side of the HAL and the simulator, for their circles
CHECK_HOST_OBJ := $(patsubst %.c,$(CHK)/host/%.o,$(wildcard hal/host/*.c sim/*/*.c))
$(CHK)/host/sim/%.o: sim/%.c Makefile checks/check.mk
	@mkdir -p $(@D)
	@$(SIM_CC) -g -MMD -MP -c $< -o $@

$(CHK)/host/%.o: %.c Makefile checks/check.mk
	@mkdir -p $(@D)
	@$(HOST_CC) $(HOST_FLAGS) -MMD -MP -c $< -o $@

check-circles: check-objects $(CHECK_HOST_OBJ)
	@python3 checks/check_circles.py $(CHK)/avr $(CHK)/host

check-format:
	@sh checks/check_format.sh $(ONLY)

check-lengths:
	@$(PY) checks/check_lengths.py $(ONLY)

check-names:
	@python3 checks/check_names.py $(ONLY)

check-symbols: check-objects $(U)/firmware.elf
	@python3 checks/check_symbols.py $(U)/firmware.elf

check-memory: check-objects $(U)/firmware.elf
	@python3 checks/check_memory.py $(U)/firmware.elf

check-frames: check-objects
	@python3 checks/check_stack.py frames

check-painted: check-objects $(SET_IMAGES) $(S)/simrun
	@python3 checks/check_stack.py painted $(SET_IMAGES)

check-waits: check-objects $(SET_IMAGES)
	@python3 checks/check_waits.py $(SET_IMAGES)

check-size: $(SET_IMAGES)
	@bad=0; for image in $^; do sh mk/scripts/size.sh $$image || bad=1; done; exit $$bad

check-seam:
	@sh checks/check_seam.sh

check-deviations: check-objects
	@$(PY) checks/check_deviations.py

check-breakages:
	@WARNINGS="$(WARNINGS)" UNITY_DIR="$(UNITY_DIR)" python3 checks/check_breakages.py

check-texts:
	@mkdir -p $(CHK)
	@python3 mk/scripts/pack_texts.py $(CHK)/reply_packed.h
	@cmp -s $(CHK)/reply_packed.h firmware/console/reply_packed.h || \
	    { echo 'texts: firmware/base/replies.h or console/reply_texts.h is not what firmware/console/reply_packed.h was made of: make texts' >&2; exit 1; }
	@echo 'texts: reply_packed.h is up to date'

# STRICT=yes: a stale page is a failure
check-pages:
	@python3 checks/check_pages.py $(if $(call yes,STRICT),--strict)

check-planted:
	@python3 host_tests/tools/checks/test_planted.py
	@python3 checks/planted.py $(ONLY)

## texts: pack the firmware's texts again after a change of firmware/base/replies.h or console/reply_texts.h
texts:
	@python3 mk/scripts/pack_texts.py firmware/console/reply_packed.h

.PHONY: texts check check-built check-objects check-planted $(CHECKS:%=check-%)

-include $(shell find $(CHK) -name '*.d' 2>/dev/null)
