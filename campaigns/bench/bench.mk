# The benchmark: cycles, flash, RAM and stack on the simulated chip, compared with float.

# WITH_DEFAULTS and the rest of the images are made by campaigns/bench/bench.py, which knows the filters from the list
BENCH_INC    := $(INCLUDES) -Ihal/avr -Ihost_tests/chip
BENCH_COMMON := -std=gnu11 -mmcu=atmega328p -DF_CPU=16000000UL -ffunction-sections -fdata-sections
BENCH_SRC    := $(wildcard host_tests/chip/float_*.c lib/filters/src/*.c lib/tilt/src/*.c) firmware/base/format.c
BENCH_DEPS   := $(BENCH_SRC) host_tests/chip/bench.c firmware/output/rows.c Makefile campaigns/bench/bench.mk $(wildcard host_tests/chip/*.h lib/*/src/*.h firmware/*/*.h hal/*.h hal/avr/*.h)

# the filters and their reference implementations do not fit the flash together: four images time a part of the list each
BENCH_PARTS  := 1 2 3 4
bench_part    = '-DBENCH_LIST(X)=$(foreach f,$(wordlist $(word $(1),1 5 9 13),$(word $(1),4 8 12 99),$(CHIP_ALL)),X($(f)))' $(if $(filter 1,$(1)),-DBENCH_THE_REST)
BENCH_IMAGES := $(BENCH_PARTS:%=$(U)/bench_%.elf) $(BENCH_PARTS:%=$(U)/bench_small_%.elf) $(U)/bench_kept.elf

$(U)/bench_small_%.elf: $(BENCH_DEPS)
	@mkdir -p $(@D)
	@$(AVR_CC) $(BENCH_COMMON) $(call bench_part,$*) $(AVR_SMALL) $(WARNINGS) $(BENCH_INC) -Wl,--gc-sections host_tests/chip/bench.c $(BENCH_SRC) -lm -o $@

$(BENCH_PARTS:%=$(U)/bench_%.elf): $(U)/bench_%.elf: $(BENCH_DEPS)
	@mkdir -p $(@D)
	@$(AVR_CC) $(BENCH_COMMON) $(call bench_part,$*) -Os $(WARNINGS) $(BENCH_INC) -Wl,--gc-sections host_tests/chip/bench.c $(BENCH_SRC) -lm -o $@

# another reference for the lightest, in the same program
$(U)/bench_kept.elf: $(BENCH_DEPS)
	@mkdir -p $(@D)
	@$(AVR_CC) $(BENCH_COMMON) $(call bench_part,1) -DFLOAT_KEPT -Os $(WARNINGS) $(BENCH_INC) -Wl,--gc-sections host_tests/chip/bench.c $(BENCH_SRC) -lm -o $@

# the firmware with two marks around a sample's path for the simulator's timing
$(U)/bench_sample/firmware/app/app.o: AVR_FLAGS += -Dpipeline_sample=bench_sample_begins -Dhealth_sample_filtered=bench_sample_ends
BENCH_SAMPLE_OBJ := $(AVR_SRC:%.c=$(U)/bench_sample/%.o) $(U)/bench_sample/host_tests/chip/bench_sample.o
$(U)/bench_sample/%.o: %.c Makefile campaigns/bench/bench.mk
	@mkdir -p $(@D)
	@$(AVR_CC) $(AVR_FLAGS) -MMD -MP -c $< -o $@

$(U)/bench_sample.elf: $(BENCH_SAMPLE_OBJ)
	@$(AVR_CC) $(AVR_LINK) $^ -o $@

# the firmware without its filters, whose clock starts at ten digits: what remains is the rest of a sample's path, and rows
BENCH_REST_OBJ := $(AVR_SRC:%.c=$(U)/bench_rest/%.o) $(U)/bench_rest/host_tests/chip/bench_rest.o
$(U)/bench_rest/%.o: IMAGE_FILTERS = $(shell python3 mk/scripts/laws.py light)
$(U)/bench_rest/firmware/path/pipeline.o: AVR_FLAGS += -Dfilter_update=bench_no_filter
$(U)/bench_rest/%.o: %.c Makefile campaigns/bench/bench.mk
	@mkdir -p $(@D)
	@$(AVR_CC) $(AVR_FLAGS) -DHAL_TIME_START_US=4200000000ul -MMD -MP -c $< -o $@

$(U)/bench_rest.elf: $(BENCH_REST_OBJ)
	@$(AVR_CC) $(AVR_LINK) $^ -o $@

# other people's filters, measured beside ours, if they are available
PEERS ?= ../shared/peers/filters

## bench: measure cycles, flash, RAM and stack of each filter, beside float and other people's (PEERS=folder), into docs/results/benchmarks.md (2 minutes)
bench:
	@sh tools/deps.sh bench
	@$(MAKE) -j2 $(BENCH_IMAGES) $(U)/bench_sample.elf $(U)/bench_rest.elf $(SET_IMAGES) $(S)/simrun
	@python3 campaigns/bench/bench.py --flags '$(BENCH_COMMON) -Wl,--gc-sections $(BENCH_INC)' --small '$(AVR_SMALL)' --sources '$(BENCH_SRC)' --parts '$(BENCH_PARTS)' --peers '$(PEERS)'

# of bench: one sample's cycles by part, in the image that is flashed
cycles: $(S)/simrun $(U)/firmware.elf
	@python3 campaigns/bench/bench_parts.py

.PHONY: bench cycles
