# The navigation image: a filter of its own on the same HAL, and the same code as a program of the PC.
STATES     ?= 12
NAVIMG_SRC    := $(wildcard nav/image/*.c) $(wildcard nav/lib/*.c) $(wildcard hal/avr/*.c)
NAVIMG_INC    := -Ihal -Inav/image -Ilib/machine/src -Inav/lib
# its records are long and its answers short
NAV_RINGS  := -DHAL_UART_RX_SIZE=128 -DHAL_UART_TX_SIZE=128
# keeps flash and stack within the budgets: stack frames do not grow by inlining
NAV_SMALL  := $(filter-out -flto-partition=one -fno-gcse-lm -fno-tree-dce -fno-tree-pre -fno-ssa-phiopt,$(AVR_SMALL)) -fno-tree-pta --param=large-stack-frame=64 --param=large-stack-frame-growth=50
NAVIMG_FLAGS   = -std=gnu11 -mmcu=atmega328p -DF_CPU=16000000UL $(NAV_SMALL) $(AVR_DEBUG) -ffunction-sections -fdata-sections \
              $(WARNINGS) $(NAVIMG_INC) -Ihal/avr $(NAV_RINGS)
nav_image   = $(U)/nav$(filter-out 12,$(1))/firmware.elf

# NAV_IMAGE(folder, states)
define NAV_IMAGE
$(U)/$(1)/%.o: %.c Makefile nav/nav.mk
	@mkdir -p $$(@D)
	@$$(AVR_CC) $$(NAVIMG_FLAGS) -DNAV_STATES=$(2) -MMD -MP -c $$< -o $$@

$(U)/$(1)/firmware.elf: $(NAVIMG_SRC:%.c=$(U)/$(1)/%.o)
	@$$(AVR_CC) -mmcu=atmega328p $$(AVR_DEBUG) $$(NAV_SMALL) -Wl,--gc-sections $$^ -lm -o $$@

$(U)/$(1)/firmware.hex: $(U)/$(1)/firmware.elf
	@avr-objcopy -O ihex -R .eeprom $$< $$@

# one of the two ways in which the PC computes as the chip does; the other is that each constant has an f
$(H)/nav_replay_$(2): nav/tests/nav_replay.c $(filter-out hal/avr/%,$(NAVIMG_SRC)) $(wildcard hal/*.h hal/host/*.h nav/image/*.h nav/lib/*.h) Makefile nav/nav.mk
	@mkdir -p $$(@D)
	@$$(HOST_CC) -std=c11 -O2 -g -ffp-contract=off -D_POSIX_C_SOURCE=200809L -DNAV_STATES=$(2) $$(NAV_RINGS) $$(WARNINGS) $$(NAVIMG_INC) -Ihal/host \
	    $$(filter-out nav/image/main.c,$$(filter %.c,$$^)) -lm -o $$@
endef
$(eval $(call NAV_IMAGE,nav,12))
$(eval $(call NAV_IMAGE,nav9,9))

NAVIMG_HOST := $(filter-out nav/image/main.c hal/avr/%,$(NAVIMG_SRC))
# with a line of its own in place of the host's HAL
$(H)/test_nav_link: nav/tests/test_nav_link.c nav/tests/nav_line.c $(NAVIMG_HOST) host_tests/support/random.c host_tests/support/test.c $(H)/unity.o nav/tests/nav_line.h $(wildcard hal/*.h nav/image/*.h nav/lib/*.h) $(MACHINE_H)
	@mkdir -p $(@D)
	@$(HOST_CC) $(HOST_FLAGS) $(NAV_RINGS) $(NAVIMG_INC) $(WARNINGS) $(SANITIZE) $(filter %.c %.o,$^) -lm -o $@

## nav: build the navigation image (paper 003) in build/uno/nav (STATES=12 or 9; docs/navigation.md)
nav:
	@sh tools/deps.sh firmware
	@$(MAKE) $(dir $(call nav_image,$(STATES)))firmware.hex
	@sh mk/scripts/size.sh $(call nav_image,$(STATES)) nav

## navflash: write the navigation image to a 16 MHz board (BOARD= PORT= STATES=12); make flash restores the tilt firmware
navflash:
	@[ $(CPU_HZ) = 16000000 ] || { echo "navflash: the navigation image needs 16 MHz, BOARD=$(BOARD) has $(CPU_HZ) Hz" >&2; exit 2; }
	@sh tools/deps.sh flash
	@python3 tools/flash.py port navflash '$(PORT)'
	@$(MAKE) $(dir $(call nav_image,$(STATES)))firmware.hex
	@python3 tools/flash.py write navflash $(BOARD) $(dir $(call nav_image,$(STATES)))firmware.hex '$(PORT)'

# needed by its tests
NAV_TESTED := $(U)/nav/firmware.elf $(U)/nav9/firmware.elf $(H)/nav_replay_12 $(H)/nav_replay_9

NAV_SECONDS ?= 500
# nav/lib without the image around it
NAV_ALONE  := $(H)/nav_chip_12 $(H)/nav_chip_9 $(U)/nav_slots_12.elf $(U)/nav_slots_9.elf
## navcheck: compare 500 s of flight in the simulated UNO with the PC, 12 and 9 states, bit for bit, into docs/results/navigation.md (14 minutes; NAV_SECONDS=)
navcheck:
	@sh tools/deps.sh tilt
	@$(MAKE) nav_images $(S)/simrun $(if $(filter 500,$(NAV_SECONDS)),$(NAV_ALONE))
	@$(PY) nav/tests/test_nav_image.py --seconds $(NAV_SECONDS) --json $(B)/nav_flights.json Equal
	@[ $(NAV_SECONDS) != 500 ] || $(PY) campaigns/pages/page_navigation.py $(B)/nav_flights.json

nav_images: $(NAV_TESTED)

.PHONY: nav nav_images navflash navcheck
