# nav/lib as the tests need it: 9 and 12 states, float and double, side by side. Each variant is one object whose only global name is
# its table of functions (nav/tests/nav_variants.h).
NAV_SRC      := $(wildcard nav/lib/*.c) nav/tests/nav_variant.c
NAV_VARIANTS := n9f n9d n12f n12d
NAV_OF_n9f   := -DNAV_STATES=9
NAV_OF_n9d   := -DNAV_STATES=9 -DNAV_DOUBLE
NAV_OF_n12f  := -DNAV_STATES=12
NAV_OF_n12d  := -DNAV_STATES=12 -DNAV_DOUBLE
NAV_TESTS    := $(patsubst nav/tests/%.c,$(H)/%,$(filter-out %/test_nav_link.c,$(wildcard nav/tests/test_nav*.c)))
NAV_FLAGS    := -O2 -ffp-contract=off -Inav/lib

# a variant, in a folder, with flags
define nav_variant
$(2)/nav/$(1)/%.o: %.c Makefile nav/nav_lib.mk
	@mkdir -p $$(@D)
	@$(HOST_CC) $(HOST_FLAGS) $(NAV_FLAGS) $(NAV_OF_$(1)) -DNAV_VARIANT=$(1) $(WARNINGS) $(3) -MMD -MP -c $$< -o $$@

$(2)/nav/$(1).o: $(NAV_SRC:%.c=$(2)/nav/$(1)/%.o)
	@ld -r $$^ -o $$@.all
	@objcopy --keep-global-symbol=$(1) $$@.all $$@
endef
$(foreach variant,$(NAV_VARIANTS),$(eval $(call nav_variant,$(variant),$(H),$(SANITIZE))))

$(NAV_TESTS): $(NAV_VARIANTS:%=$(H)/nav/%.o)

# nav/lib alone in the simulated chip: cycles of each slot, flash, stack, and every bit beside the PC's (build/host/nav_chip_12 ELF SECONDS)
NAV_CHIP_DEPS := nav/tests/chip/nav_slots.c nav/tests/chip/nav_box.h $(wildcard nav/lib/*) Makefile nav/nav_lib.mk
$(U)/nav_slots_%.elf: $(NAV_CHIP_DEPS)
	@mkdir -p $(@D)
	@$(AVR_CC) -std=gnu11 -mmcu=atmega328p $(AVR_SMALL) -ffp-contract=off -ffunction-sections $(WARNINGS) -DNAV_STATES=$* -Inav/lib -Wl,--gc-sections \
	    nav/tests/chip/nav_slots.c $(wildcard nav/lib/*.c) -lm -o $@

$(H)/nav_chip_%: nav/tests/nav_chip.c host_tests/support/flight.c host_tests/support/random.c host_tests/support/flight.h $(NAV_CHIP_DEPS)
	@mkdir -p $(@D)
	@$(HOST_CC) -std=gnu11 -O2 -g -ffp-contract=off $(WARNINGS) -DNAV_STATES=$* -Inav/lib -Ihost_tests -Inav/tests/chip \
	    $$(pkg-config --cflags simavr | sed 's/-I/-isystem /g') -isystem /usr/include/simavr $(filter %.c,$(filter-out nav/tests/chip/%,$^)) \
	    $$(pkg-config --libs simavr) -lelf -lm -o $@
