# lib/nav as the tests need it: 9 and 12 states, float and double, side by side. Each variant is one object whose only global name is
# its table of functions (host_tests/nav_variants.h).
NAV_SRC      := $(wildcard lib/nav/src/*.c) host_tests/nav_variant.c
NAV_VARIANTS := n9f n9d n12f n12d
NAV_OF_n9f   := -DNAV_STATES=9
NAV_OF_n9d   := -DNAV_STATES=9 -DNAV_DOUBLE
NAV_OF_n12f  := -DNAV_STATES=12
NAV_OF_n12d  := -DNAV_STATES=12 -DNAV_DOUBLE
NAV_TESTS    := $(patsubst host_tests/%.c,$(H)/%,$(wildcard host_tests/test_nav*.c))
NAV_FLAGS    := -O2 -ffp-contract=off -Ilib/nav/src

define nav_variant
$(H)/nav/$(1)/%.o: %.c Makefile mk/nav_lib.mk
	@mkdir -p $$(@D)
	@$(HOST_CC) $(HOST_FLAGS) $(NAV_FLAGS) $(NAV_OF_$(1)) -DNAV_VARIANT=$(1) $(WARNINGS) $(SANITIZE) -MMD -MP -c $$< -o $$@

$(H)/nav/$(1).o: $(NAV_SRC:%.c=$(H)/nav/$(1)/%.o)
	@ld -r $$^ -o $$@.all
	@objcopy --keep-global-symbol=$(1) $$@.all $$@
endef
$(foreach variant,$(NAV_VARIANTS),$(eval $(call nav_variant,$(variant))))

$(NAV_TESTS): $(NAV_VARIANTS:%=$(H)/nav/%.o) $(H)/host_tests/nav_flights.o
