# Fuzz targets (host_tests/fuzz). The program under test is linked into one object whose variables have sections of their
# own, so that each input finds them as after a reset (fuzz_support.c). Results and inputs are under build/fuzz.
FZ           := $(B)/fuzz
FUZZ_TARGETS := commands stream driver filters
FUZZ_APP_OBJ := $(HOST_SRC:%.c=$(FZ)/app/%.o)
FUZZ_COMMON  := fuzz_support fuzz_protocol fuzz_said fuzz_parameters
FUZZ_LINKED  := $(FUZZ_COMMON:%=$(FZ)/%.o) $(LAW_SUPPORT:host_tests/%.c=$(FZ)/%.o) $(FZ)/fuzz_drive.o $(FZ)/fuzz_mutate.o $(FZ)/fuzz_dictionary.o
FUZZ_BIN     := $(FUZZ_TARGETS:%=$(FZ)/fuzz_%)
FUZZ_LIBFUZZER := $(FUZZ_TARGETS:%=$(FZ)/libfuzzer_%)
FUZZ_GCC     := $(HOST_CC) $(HOST_FLAGS) -Ihost_tests/fuzz $(WARNINGS) $(SANITIZE)
# CLANG='clang-14 ...' uses that one; CLANG= uses none
CLANG        ?= $(firstword $(foreach c,clang clang-19 clang-16 clang-15 clang-14,$(shell command -v $(c))))
FUZZ_CLANG   = $(CLANG) $(HOST_FLAGS) -Ihost_tests/fuzz $(SANITIZE) -fsanitize=fuzzer-no-link
SECONDS      ?= 20
SEED         ?= 1

FUZZ_GROUP = ld -r -o $@.part $(filter %.o,$^) && \
    objcopy --rename-section .data=fuzz_data --rename-section .bss=fuzz_bss,alloc,load,contents,data $@.part $@ && rm $@.part

$(FZ)/app/%.o: %.c Makefile campaigns/fuzz/fuzz.mk
	@mkdir -p $(@D)
	@$(FUZZ_GCC) -fsanitize-coverage=trace-pc -MMD -MP -c $< -o $@

$(FZ)/app.o: $(FUZZ_APP_OBJ)
	@$(FUZZ_GROUP)

$(FZ)/fuzz_%.o: host_tests/fuzz/fuzz_%.c Makefile campaigns/fuzz/fuzz.mk
	@mkdir -p $(@D)
	@$(FUZZ_GCC) -MMD -MP -c $< -o $@

$(FZ)/support/%.o: host_tests/support/%.c Makefile campaigns/fuzz/fuzz.mk
	@mkdir -p $(@D)
	@$(FUZZ_GCC) -MMD -MP -c $< -o $@

$(FUZZ_BIN): $(FZ)/fuzz_%: $(FZ)/fuzz_%.o $(FUZZ_LINKED) $(FZ)/app.o
	@$(HOST_CC) $(SANITIZE) $^ -lm -o $@

# the same with one source broken, for each breakage that a fuzz target judges: NAME:TARGET:SOURCE (asked only when they are built)
ifneq ($(findstring fuzz,$(MAKECMDGOALS)),)
FUZZ_PLANTS  := $(shell python3 campaigns/fuzz/fuzz.py plants)
endif
FUZZ_PLANTED := $(foreach p,$(FUZZ_PLANTS),$(FZ)/planted/$(firstword $(subst :, ,$(p))))

define FUZZ_PLANT
$(FZ)/planted/$(1).c: $(3) $(wildcard campaigns/breakages/breakages*.txt) checks/planted.txt campaigns/breakages/anchors.py campaigns/fuzz/fuzz.py
	@mkdir -p $$(@D)
	@python3 campaigns/fuzz/fuzz.py plant $(1) $$@

$(FZ)/planted/$(1).o: $(FZ)/planted/$(1).c $(FZ)/app/$(3:.c=.o)
	@$$(FUZZ_GCC) -fsanitize-coverage=trace-pc -c $$< -o $$@

$(FZ)/planted/$(1).app.o: $(FZ)/planted/$(1).o $(filter-out $(FZ)/app/$(3:.c=.o),$(FUZZ_APP_OBJ))
	@$$(FUZZ_GROUP)

$(FZ)/planted/$(1): $(FZ)/fuzz_$(2).o $(FUZZ_LINKED) $(FZ)/planted/$(1).app.o
	@$$(HOST_CC) $$(SANITIZE) $$^ -lm -o $$@
endef
$(foreach p,$(FUZZ_PLANTS),$(eval $(call FUZZ_PLANT,$(word 1,$(subst :, ,$(p))),$(word 2,$(subst :, ,$(p))),$(word 3,$(subst :, ,$(p))))))

# with libFuzzer, if there is a clang that has it
$(FZ)/clang/%.o: %.c Makefile campaigns/fuzz/fuzz.mk
	@mkdir -p $(@D)
	@$(FUZZ_CLANG) -MMD -MP -c $< -o $@

$(FZ)/clang/app.o: $(HOST_SRC:%.c=$(FZ)/clang/%.o)
	@$(FUZZ_GROUP)

$(FUZZ_LIBFUZZER): $(FZ)/libfuzzer_%: $(FZ)/clang/host_tests/fuzz/fuzz_%.o \
        $(FZ)/clang/host_tests/fuzz/fuzz_support.o $(FZ)/clang/host_tests/fuzz/fuzz_protocol.o $(LAW_SUPPORT:%.c=$(FZ)/clang/%.o) \
        $(FZ)/clang/app.o
	@$(CLANG) $(SANITIZE) -fsanitize=fuzzer $^ -lm -o $@

## fuzz: feed random inputs to commands, stream reader, driver and filters (SECONDS=20 in all, SEED=1)
fuzz:
	@sh tools/deps.sh fuzz
	@$(MAKE) -j2 $(FUZZ_BIN) $(FUZZ_PLANTED)
	@if echo 'int LLVMFuzzerTestOneInput(const char *d, unsigned long n) { return d && n > 9; }' | \
	    $(if $(CLANG),$(CLANG),false) -fsanitize=fuzzer -x c - -o $(FZ)/has_libfuzzer 2> $(FZ)/has_libfuzzer.log; then \
	    $(MAKE) -j2 $(FUZZ_LIBFUZZER) && LIBFUZZER=yes python3 campaigns/fuzz/fuzz.py run $(SECONDS) $(SEED); \
	else \
	    python3 campaigns/fuzz/fuzz.py run $(SECONDS) $(SEED); \
	fi

# interesting inputs are kept
clean: clean_fuzz
clean_fuzz:
	@rm -rf $(FZ)/app $(FZ)/support $(FZ)/clang $(FZ)/planted $(FZ)/*.o $(FZ)/*.d $(FUZZ_BIN) $(FUZZ_LIBFUZZER)

.PHONY: fuzz clean_fuzz

-include $(shell find $(FZ) -name '*.d' 2>/dev/null)
