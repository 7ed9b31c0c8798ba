# The PC: the product and the tests' helpers as one archive a folder, with the sanitizers for tests and optimised for tools. Which archives
# and references a test needs follows from what it includes (mk/scripts/test_parts.py), so no test waits for what it does not use.
H := $(B)/host
HOST_CC    := gcc
HOST_CXX   := g++
SANITIZE   := -fsanitize=address,undefined -fno-sanitize-recover=all
SIM_INC    := -Isim/model -Isim/run -Isim/faults -Isim/judge
HOST_INC   := $(INCLUDES) -Ihal/host -Isim/model -Isim/judge -Ihost_tests -Inav/tests -isystem $(UNITY_DIR)
HOST_FLAGS := -std=c11 -O1 -g -D_POSIX_C_SOURCE=200809L -DHANG_TEST=1 -DSUPERVISOR=1 -DUNITY_INCLUDE_DOUBLE $(HOST_INC)
MODEL_SRC  := sim/model/adxl345_model.c sim/model/adxl345_variants.c sim/model/feed.c sim/model/stream.c
HOST_SRC   := $(filter-out firmware/app/main.c,$(APP_SRC)) $(LIB_SRC) $(wildcard hal/host/*.c) $(MODEL_SRC)
# those of them that know the laws, on the chip too
LAW_SUPPORT := host_tests/support/random32.c $(wildcard host_tests/support/filter*.c host_tests/support/law_*.c)
SUPPORT_SRC := $(wildcard host_tests/support/*.c)
# a test's program is build/host/test_NAME, whatever room its source is in
TEST_SRC    := $(wildcard host_tests/*/test_*.c nav/tests/test_*.c)
TESTS       := $(addprefix $(H)/,$(basename $(notdir $(TEST_SRC))))

$(H)/%.o: %.c Makefile mk/host.mk
	@mkdir -p $(@D)
	@$(HOST_CC) $(HOST_FLAGS) $(WARNINGS) $(SANITIZE) -MMD -MP -c $< -o $@

# tools are optimised and without sanitizers
$(H)/o2/%.o: %.c Makefile mk/host.mk
	@mkdir -p $(@D)
	@$(HOST_CC) $(HOST_FLAGS) -O2 $(WARNINGS) -MMD -MP -c $< -o $@

# The references. Nearly all of their time goes into Eigen's templates: half the debug information and -O1 halve it, and Eigen still asserts its
# own bounds; with the address sanitizer test_adaptive_reference would take a minute more.
$(H)/%.o: %.cpp Makefile mk/host.mk
	@mkdir -p $(@D)
	@$(HOST_CXX) -std=c++17 -O1 -g1 -Wall -Wextra -Werror $(HOST_INC) -isystem /usr/include/eigen3 -fsanitize=undefined -fno-sanitize-recover=all -MMD -MP -c $< -o $@

$(H)/unity.o: $(UNITY_DIR)/unity.c
	@mkdir -p $(@D)
	@$(HOST_CC) -std=c11 -O1 -g -DUNITY_INCLUDE_DOUBLE -DUNITY_USE_FLUSH_STDOUT $(SANITIZE) -c $< -o $@

# ARCHIVE(folder of objects, name, sources)
define ARCHIVE
$(1)/lib$(2).a: $(3:%.c=$(1)/%.o)
	@rm -f $$@
	@ar rcs $$@ $$^
endef
ARCHIVED := filters tilt adxl345 firmware hal model support
SRC_filters  := $(wildcard lib/filters/src/*.c)
SRC_tilt     := $(wildcard lib/tilt/src/*.c)
SRC_adxl345  := $(wildcard lib/adxl345/src/*.c)
SRC_firmware := $(filter-out firmware/app/main.c,$(APP_SRC))
SRC_hal      := $(wildcard hal/host/*.c)
SRC_model    := $(MODEL_SRC)
SRC_support  := $(SUPPORT_SRC)
$(foreach folder,$(H) $(H)/o2 $(B)/coverage,$(foreach a,$(ARCHIVED),$(eval $(call ARCHIVE,$(folder),$(a),$(SRC_$(a))))))
ARCHIVES_O2 := $(ARCHIVED:%=$(H)/o2/lib%.a)
linked       = $(filter %.o,$(1)) -Wl,--start-group $(filter %.a,$(1)) -Wl,--end-group

$(foreach t,$(filter-out %/test_nav_link.c,$(TEST_SRC)),$(eval $(H)/$(basename $(notdir $(t))): $(H)/$(t:.c=.o)))
$(filter-out %/test_nav_link,$(TESTS)): $(H)/test_%: $(H)/unity.o $(H)/libsupport.a
	@$(HOST_CXX) $(SANITIZE) $(call linked,$^) -lm -o $@

# One line a test: build/host/test_NAME: its archives and further objects. Moved there whole: make -nB, which writes it again, may run beside another make. Without
# python3, which make deps installs, targets that need no test can still be built.
PARTS := $(H)/parts.mk $(if $(filter coverage $(B)/coverage/%,$(MAKECMDGOALS)),$(B)/coverage/parts.mk)
ifneq ($(filter-out help deps clean,$(MAKECMDGOALS)),)
$(PARTS): mk/scripts/test_parts.py $(wildcard $(addprefix host_tests/*/*.,c h cpp hpp) nav/tests/*) $(HOST_SRC) $(wildcard */*.h sim/*/*.h firmware/*/*.h hal/*/*.h lib/*/src/*.h)
	@mkdir -p $(@D)
	@! command -v python3 > /dev/null || { python3 mk/scripts/test_parts.py $(@D) > $@.$$$$ && mv $@.$$$$ $@; }
-include $(PARTS)
endif

$(H)/native_replay: $(H)/o2/host_tests/system/native_replay.o
$(H)/recordings: $(H)/o2/host_tests/tools/campaigns/recordings.o
$(H)/native_replay $(H)/recordings: $(ARCHIVES_O2)
	@$(HOST_CC) $(call linked,$^) -lm -o $@

# with paper 002's references, in C++, as contenders
PAPER_AXES_O2 := $(addprefix $(H)/o2/host_tests/reference/,robust.o robust_joint.o)
$(H)/default_filter: $(H)/o2/host_tests/tools/campaigns/default_filter.o $(PAPER_AXES_O2) $(ARCHIVES_O2)
	@$(HOST_CXX) $(call linked,$^) -lm -o $@

$(H)/o2/host_tests/reference/%.o: host_tests/reference/%.cpp host_tests/reference/robust.h host_tests/reference/robust_joint.h host_tests/reference/matrices.hpp Makefile mk/host.mk
	@mkdir -p $(@D)
	@$(HOST_CXX) -std=c++17 -O2 -DEIGEN_NO_DEBUG -Wall -Wextra -Wconversion -Wshadow -Werror -Ihost_tests -isystem /usr/include/eigen3 -c $< -o $@

$(H)/pipeline_replay: $(H)/o2/host_tests/system/pipeline_replay.o $(ARCHIVES_O2)
	@$(HOST_CC) -Wl,--wrap=choice_begin,--wrap=filter_noise_r_lsb2_q8 $(call linked,$^) -lm -o $@

$(H)/exhaustive_isqrt: host_tests/tilt/exhaustive_isqrt.c lib/tilt/src/tilt.c lib/filters/src/fx.c $(wildcard lib/*/src/*.h)
	@mkdir -p $(@D)
	@$(HOST_CC) $(HOST_FLAGS) -O3 -flto $(WARNINGS) $(filter %.c,$^) -o $@
