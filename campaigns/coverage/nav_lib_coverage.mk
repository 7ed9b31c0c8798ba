# nav/lib four times, as its tests need it: gcovr adds up what each variant ran; a line that exists in one variant must run there
COVERAGE_NAV := --coverage -O0
$(foreach variant,$(NAV_VARIANTS),$(eval $(call nav_variant,$(variant),$(C),$(COVERAGE_NAV))))
COVERAGE_NAV_TESTS := $(filter $(NAV_TESTS:$(H)/%=$(C)/%),$(COVERAGE_TESTS))
$(COVERAGE_NAV_TESTS): $(NAV_VARIANTS:%=$(C)/nav/%.o)

# and a fifth time under the navigation image's link, with a link line of its own in place of the host's HAL
COVERAGE_LINK := $(patsubst %.c,$(C)/nav/link/%.o,$(NAVIMG_HOST) nav/tests/test_nav_link.c nav/tests/nav_line.c host_tests/support/random.c host_tests/support/test.c)
$(C)/nav/link/%.o: %.c Makefile campaigns/coverage/coverage.mk nav/nav.mk
	@mkdir -p $(@D)
	@$(HOST_CC) $(HOST_FLAGS) $(NAV_RINGS) $(NAVIMG_INC) $(WARNINGS) $(COVERAGE_NAV) -MMD -MP -c $< -o $@

$(C)/test_nav_link: $(COVERAGE_LINK) $(C)/unity.o
	@$(HOST_CC) --coverage $^ -lm -o $@
