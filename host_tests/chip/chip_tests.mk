# The portable part of the unit tests, and the long sequence of filter calls, as images for the ATmega328P.

# the chip's flash holds about nine filters: the tests that go over the list run in two images, which link these
CHIP_ALL    := $(shell sed -n 's/^    X(\([a-z0-9_]*\)).*/\1/p' lib/filters/src/filter.h)
# the first and the last three are the largest
CHIP_SECOND := $(firstword $(CHIP_ALL)) $(wordlist $(words $(wordlist 3,99,$(CHIP_ALL))),99,$(CHIP_ALL))
CHIP_FIRST  := $(filter-out $(CHIP_SECOND),$(CHIP_ALL))
linked_flag  = '-DFILTER_LINKED(X)=$(foreach f,$(1),X($(f)))'
own_tests    = $(filter $(basename $(notdir $(TEST_SRC))),$(1:%=test_%))
# the object of a test, or of its second image
test_object  = $(patsubst %.c,$(U)/tests/%.o,$(filter %/$(1:_2=).c,$(TEST_SRC)))
UNITY_1     := test_filters test_filter_gaps test_fx test_wide test_noise test_tilt test_calibration $(call own_tests,$(CHIP_FIRST))
UNITY_2     := test_filters_2 test_filter_gaps_2 $(call own_tests,$(CHIP_SECOND))
CHIP_TESTS  := $(patsubst %,$(U)/tests/%.elf,$(UNITY_1) $(UNITY_2) filter_sequence_1 filter_sequence_2)
BITEXACT    := host_tests/bitexact
SEQUENCE    := $(addprefix $(BITEXACT)/,sequence_main.c filter_sequence.c crc32.c output.c) $(LAW_SUPPORT)
FILTER_SRC  := $(wildcard lib/filters/src/*.c lib/tilt/src/*.c)
CHIP_FLAGS  := -std=gnu11 -mmcu=atmega328p -DF_CPU=16000000UL $(AVR_SMALL) -ffunction-sections -fdata-sections $(WARNINGS) \
               $(INCLUDES) -Ihost_tests -I$(BITEXACT) -isystem $(UNITY_DIR)
CHIP_COMMON := $(FILTER_SRC) $(LAW_SUPPORT) $(BITEXACT)/output.c $(BITEXACT)/output_chip.c
ANY_FILTER  := lib/filters/src/filter_list
CHIP_UNITY  := $(addprefix $(U)/tests/host_tests/,chip/unity_chip.o support/test.o)
CHIP_OBJ    := $(patsubst %.c,$(U)/tests/%.o,$(filter-out $(ANY_FILTER).c,$(CHIP_COMMON))) $(CHIP_UNITY) $(U)/tests/unity.o
UNITY_CHIP  := -include host_tests/chip/unity_chip.h

$(U)/tests/%.o: %.c Makefile host_tests/chip/chip_tests.mk
	@mkdir -p $(@D)
	@$(AVR_CC) $(CHIP_FLAGS) -MMD -MP -c $< -o $@

$(foreach t,$(UNITY_1) $(UNITY_2),$(call test_object,$(t))) $(CHIP_UNITY): CHIP_FLAGS += $(UNITY_CHIP)

# not gnu11: there Unity reads the macro AVR as a reason to keep its texts where it does not find them
$(U)/tests/unity.o: $(UNITY_DIR)/unity.c host_tests/chip/unity_chip.h Makefile host_tests/chip/chip_tests.mk
	@mkdir -p $(@D)
	@$(AVR_CC) -std=c11 -mmcu=atmega328p $(AVR_SMALL) -ffunction-sections -I$(BITEXACT) $(UNITY_CHIP) -c $< -o $@

$(U)/tests/$(ANY_FILTER)_1.o $(U)/tests/$(ANY_FILTER)_2.o: $(ANY_FILTER).c Makefile host_tests/chip/chip_tests.mk
	@mkdir -p $(@D)
	@$(AVR_CC) $(CHIP_FLAGS) $(call linked_flag,$(if $(findstring _1.o,$@),$(CHIP_FIRST),$(CHIP_SECOND))) -MMD -MP -c $< -o $@

$(foreach t,$(UNITY_1) $(UNITY_2),$(eval $(U)/tests/$(t).elf: $(call test_object,$(t))))
$(UNITY_1:%=$(U)/tests/%.elf): $(CHIP_OBJ) $(U)/tests/$(ANY_FILTER)_1.o
	@$(AVR_CC) $(AVR_LINK) $^ -o $@

$(UNITY_2:%=$(U)/tests/%.elf): $(CHIP_OBJ) $(U)/tests/$(ANY_FILTER)_2.o
	@$(AVR_CC) $(AVR_LINK) $^ -o $@

SEQUENCE_OBJ := $(patsubst %.c,$(U)/tests/%.o,$(SEQUENCE) $(BITEXACT)/output_chip.c $(filter-out $(ANY_FILTER).c,$(FILTER_SRC)))
$(U)/tests/filter_sequence_%.elf: $(SEQUENCE_OBJ) $(U)/tests/$(ANY_FILTER)_%.o
	@$(AVR_CC) $(AVR_LINK) $^ -o $@

# the whole list, and the reference for the chip's two programs
SEQUENCES := $(H)/filter_sequence $(H)/filter_sequence_1 $(H)/filter_sequence_2
$(H)/filter_sequence_1: SEQUENCE_OF = $(call linked_flag,$(CHIP_FIRST))
$(H)/filter_sequence_2: SEQUENCE_OF = $(call linked_flag,$(CHIP_SECOND))
$(SEQUENCES): $(SEQUENCE) $(BITEXACT)/output_pc.c $(FILTER_SRC) $(wildcard lib/*/src/*.h host_tests/support/*.h $(BITEXACT)/*.h) \
              Makefile host_tests/chip/chip_tests.mk
	@mkdir -p $(@D)
	@$(HOST_CC) $(HOST_FLAGS) -O2 $(WARNINGS) $(SANITIZE) $(SEQUENCE_OF) -I$(BITEXACT) $(filter %.c,$^) -lm -o $@
