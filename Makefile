# tilt-uno: `make` alone prints what there is. Everything is built under build/.
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
MAKEFLAGS += --no-builtin-rules --no-print-directory
SHELL := /bin/sh
# compilers name the folder as PWD does: not by a link through which it was entered
export PWD := $(CURDIR)

B := build
PY := $(B)/venv/bin/python
UNITY_DIR ?= $(B)/unity

WARNINGS := -Wall -Wextra -Wconversion -Wsign-conversion -Wshadow -Wundef -Wdouble-promotion -Wstrict-prototypes \
            -Wmissing-prototypes -Wcast-qual -Werror
MACHINE_H := lib/machine/src/machine.h
LIB_DIRS := lib/machine/src lib/filters/src lib/tilt/src lib/adxl345/src
LIB_SRC  := $(wildcard lib/filters/src/*.c lib/tilt/src/*.c lib/adxl345/src/*.c)
APP_SRC  := $(wildcard firmware/*/*.c)
INCLUDES := -Ihal -Ifirmware $(addprefix -I,$(LIB_DIRS))

# make itself would ignore a variable that no makefile knows
ifeq ($(MAKELEVEL),0)
TYPED    := $(foreach name,$(.VARIABLES),$(if $(filter command,$(origin $(name))),$(name)))
MISSPELT := $(if $(TYPED),$(shell python3 mk/scripts/misspelt.py $(TYPED)))
$(if $(MISSPELT),$(error $(MISSPELT)))
endif

# all parts of this file, sorted by name whatever folder they are in
RULES := $(wildcard $(addsuffix *.mk,mk/ checks/ nav/ second/ web/ tools/*/ campaigns/ campaigns/*/ host_tests/*/))
RULES := $(foreach rule,$(sort $(foreach rule,$(RULES),$(notdir $(rule))|$(rule))),$(lastword $(subst |, ,$(rule))))

## help: list the targets
help:
	@echo "tilt-uno: tilt from an Arduino UNO and an ADXL345 that outliers cannot fool"
	@sed -n 's/^## \([a-z]*\): /  make \1|/p' Makefile $(RULES) | awk -F'|' '{printf "%-16s %s\n", $$1, $$2}'

## deps: install what any target needs (prints what, first)
deps:
	@sh tools/deps.sh sim test check flash tilt
	@sh tools/deps.sh second || echo "deps: make second will be skipped"

.PHONY: help deps

# --- the UNO ---------------------------------------------------------------------------------------------------------
include mk/boards.mk
U := $(B)/$(BOARD_FOLDER)
AVR_CC      := avr-gcc
# the smallest image with avr-gcc 5.4.0 (and no switch tables in RAM); the filters keep their speed
AVR_SMALL   := -Os -flto -flto-partition=one -mrelax -mcall-prologues -fshort-enums -fno-inline-small-functions \
               -fno-tree-dominator-opts -fno-tree-switch-conversion -fno-forward-propagate \
               -fno-tree-loop-ivcanon -fno-tree-scev-cprop -fno-tree-copy-prop -fno-move-loop-invariants -frename-registers -fno-jump-tables -mstrict-X -fno-if-conversion -fno-guess-branch-probability -fno-strict-aliasing -fno-gcse-lm -fno-tree-dce -fno-tree-pre -fno-ssa-phiopt
# lines, which change a few bytes, and no variables, which would change 50 of code through link-time optimisation: every program below,
# flashed, tested, profiled or traced, is the same bits. The folder's name is left out too: the linker's relaxation keeps a redundant `ret` whose
# address equals the offset of some debug string, so an image would depend on the length of that name
AVR_DEBUG   := -gdwarf-2 -g1 -gno-record-gcc-switches -fdebug-prefix-map='$(subst ','\'',$(CURDIR))=.'
AVR_FLAGS    = -std=gnu11 -mmcu=atmega328p -DF_CPU=$(CPU_HZ)UL $(AVR_SMALL) $(AVR_DEBUG) -ffunction-sections -fdata-sections $(WARNINGS) \
               $(INCLUDES) -Ihal/avr $(FILTER_FLAG)
# calls within 4 KB take half the bytes: functions.ld orders the functions so that most calls are (mk/scripts/layout.py)
UNO_LD      := hal/avr/uno.ld hal/avr/functions.ld
# a clock other than the UNO's is a symbol in the image, for the simulator
COMMA       := ,
AVR_LINK    := -mmcu=atmega328p $(AVR_DEBUG) $(AVR_SMALL) -ffunction-sections -Wl,--gc-sections -Wl,-T,hal/avr/uno.ld \
               $(if $(filter-out 16000000,$(CPU_HZ)),-Wl$(COMMA)--defsym=cpu_hz=$(CPU_HZ))
AVR_SRC     := $(APP_SRC) $(LIB_SRC) $(wildcard hal/avr/*.c)
AVR_OBJ     := $(AVR_SRC:%.c=$(U)/%.o)
include mk/images.mk

# assembler primitives against their C twins, on the chip: with plain -Os, and as the firmware is built
TWINS_SRC := host_tests/chip/fx_twins.c lib/filters/src/fx.c lib/filters/src/fx_avr.c
$(U)/fx_twins.elf: $(TWINS_SRC) lib/filters/src/fx.h lib/filters/src/fx_avr.h lib/filters/src/fx_dot.h $(MACHINE_H) Makefile
	@mkdir -p $(@D)
	@$(AVR_CC) -std=gnu11 -mmcu=atmega328p -DF_CPU=16000000UL -Os $(WARNINGS) -Ilib/machine/src -Ilib/filters/src $(TWINS_SRC) -o $@

$(U)/fx_twins_firmware.elf: $(TWINS_SRC) lib/filters/src/fx.h lib/filters/src/fx_avr.h lib/filters/src/fx_dot.h $(MACHINE_H) Makefile
	@mkdir -p $(@D)
	@$(AVR_CC) $(AVR_FLAGS) -Wl,--gc-sections $(TWINS_SRC) -o $@

$(U)/hal_probe.elf: host_tests/chip/hal_probe.c $(wildcard hal/avr/*.c hal/*.h hal/avr/*.h) $(MACHINE_H) Makefile
	@mkdir -p $(@D)
	@$(AVR_CC) -std=gnu11 -mmcu=atmega328p -DF_CPU=16000000UL -Os $(WARNINGS) -Ihal -Ihal/avr -Ilib/machine/src $(filter %.c,$^) -o $@

$(U)/store_probe.elf: host_tests/chip/store_probe.c firmware/settings/store.c $(wildcard hal/avr/*.c hal/*.h hal/avr/*.h) firmware/settings/store.h $(MACHINE_H) Makefile
	@mkdir -p $(@D)
	@$(AVR_CC) -std=gnu11 -mmcu=atmega328p -DF_CPU=16000000UL -Os $(WARNINGS) -Ihal -Ihal/avr -Ifirmware -Ilib/machine/src -Ilib/filters/src $(filter %.c,$^) -o $@

TEST_IMAGES := $(U)/hal_probe.elf $(U)/store_probe.elf $(U)/fx_twins.elf $(U)/fx_twins_firmware.elf $(FIRMWARE_IMAGES)

$(U)/firmware.hex: $(U)/firmware.elf
	@avr-objcopy -O ihex -R .eeprom $< $@

## firmware: build build/uno/firmware.elf and .hex (BOARD= from mk/boards.txt; FILTERS=: a set of mk/images.mk, or names of filters)
firmware:
	@sh tools/deps.sh firmware
	@$(SAY_FILTERS)
	@$(MAKE) $(U)/firmware.hex size

## size: print flash and RAM of the firmware
size: $(U)/firmware.elf
	@sh mk/scripts/size.sh $< '' $(BOARD_FLASH)

## flash: write the firmware to a board (BOARD=nano-old: old boot loader; PORT= if there are several; FILTERS=)
flash:
	@sh tools/deps.sh flash
	@python3 tools/flash.py port flash '$(PORT)'
	@$(SAY_FILTERS)
	@$(MAKE) $(U)/firmware.hex
	@python3 tools/flash.py write flash $(BOARD) $(U)/firmware.hex '$(PORT)'

## monitor: show what the board sends (PORT=, BAUD=); Ctrl-C ends
monitor:
	@python3 tools/flash.py monitor $(BAUD) '$(PORT)'

.PHONY: firmware size flash monitor

# --- the PC ---------------------------------------------------------------------------------------------------------------
include mk/host.mk

# --- the simulator ---------------------------------------------------------------------------------------------------
S := $(B)/sim
SIMRUN_SRC := $(wildcard sim/*/*.c)
# libsimavr as an archive, if there is one: calls without a detour save a tenth of the time; rows are the same
SIMAVR_LINK := $(if $(wildcard /usr/lib/*/libsimavr.a),-l:libsimavr.a,$$(pkg-config --libs simavr))
SIM_CC = $(HOST_CC) -std=gnu11 -O2 $(WARNINGS) $(SIM_INC) -Ilib/adxl345/src $$(pkg-config --cflags simavr | sed 's/-I/-isystem /g') \
         -isystem /usr/include/simavr
$(S)/simrun: $(SIMRUN_SRC) $(wildcard sim/*/*.h)
	@mkdir -p $(@D)
	@$(SIM_CC) -flto -g $(SIMRUN_SRC) $(SIMAVR_LINK) -lelf -lm -lpthread -lutil -o $@
	@echo "built $@"

STREAM ?= sim/streams/outliers-15pct.csv
FILTER ?= $(firstword $(FILTERS_everyday))
RATE   ?= 100
OUT    ?= $(S)/$(basename $(notdir $(STREAM))).$(FILTER).out.csv

## sim: run the firmware on a recorded stream in the simulator and draw it (STREAM= FILTER= RATE= OUT=)
sim:
	@sh tools/sim.sh check "$(STREAM)" "$(OUT)"
	@sh tools/deps.sh sim
	@$(MAKE) $(call image_with,$(FILTER)) $(S)/simrun
	@sh tools/sim.sh "$(call image_with,$(FILTER))" "$(STREAM)" "$(FILTER)" "$(RATE)" "$(OUT)"

# what the test programs need to know of this build
TEST_ENV = CHIP_TESTS="$(CHIP_TESTS)" WARNINGS="$(WARNINGS)" AVR_SMALL="$(AVR_SMALL)" CHIP_SECOND="$(CHIP_SECOND)"

## test: run the unit tests on the PC, then the firmware in the simulator against the PC
test:
	@sh tools/deps.sh test
	@sh tools/deps.sh flashtest || echo "test: test_flash will be skipped"
	@sh tools/deps.sh arduino || echo "test: the sketches of test_arduino will be skipped"
	@sh tools/deps.sh design || echo "test: test_design will be skipped"
	@sh tools/deps.sh tilt || echo "test: the tests of tilt will be skipped"
	@sh tools/deps.sh live || echo "test: the tests of the page of tilt live will be skipped"
	@sh tools/deps.sh demo || echo "test: the tests of the demo will be skipped"
	@python3 mk/scripts/progress.py $(MAKE) -j2 --no-print-directory $$($(TEST_ENV) python3 campaigns/tests/test_table.py targets)
	@$(TEST_ENV) python3 campaigns/tests/run_tests.py

## t: build and run one test (T=sprf; T="sprf golden": both; T="system_tests equals": some of its tests; T=list: all names)
t:
	@sh tools/deps.sh test
	@$(TEST_ENV) python3 campaigns/tests/test_table.py t $(T)

## quick: run all unit tests on the PC (1 minute once built)
quick:
	@sh tools/deps.sh test
	@python3 mk/scripts/progress.py $(MAKE) -j2 --no-print-directory $$(python3 campaigns/tests/test_table.py targets quick)
	@$(TEST_ENV) python3 campaigns/tests/run_tests.py quick

# needed by the tests of the whole firmware
system_images: $(U)/firmware.elf $(TEST_IMAGES) $(SLOW_IMAGE) $(S)/simrun $(H)/native_replay $(H)/pipeline_replay

## clean: remove what was built (the downloads in build/unity and build/venv stay)
clean:
	@rm -rf $(U) $(H) $(S) $(CHK) $(B)/planted $(B)/*.json

# the rules of further targets, each file beside what it runs
include $(filter-out mk/boards.mk mk/images.mk mk/host.mk,$(RULES))

# keep the test objects: no other .SECONDARY may name targets, or only those would be kept
.SECONDARY:

.PHONY: sim test t quick system_images clean

-include $(shell find $(U) $(H) -name '*.d' 2>/dev/null)
