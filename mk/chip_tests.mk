# The portable part of the unit tests, and the long sequence of filter calls, as images for the ATmega328P.

CHIP_UNITY  := test_filters test_filter_gaps test_fx test_kf test_kf3 test_lrf test_soft test_sprf test_synth test_two_state_wide test_sprf_paper \
               test_shrf test_pbf test_af test_noise test_tilt
CHIP_TESTS  := $(CHIP_UNITY:%=$(U)/tests/%.elf) $(U)/tests/filter_sequence.elf
BITEXACT    := host_tests/bitexact
SEQUENCE    := $(addprefix $(BITEXACT)/,sequence_main.c filter_sequence.c crc32.c output.c) host_tests/support_filters.c host_tests/support_filter_bounds.c
FILTER_SRC  := $(wildcard lib/filters/src/*.c lib/tilt/src/*.c)
CHIP_FLAGS  := -std=gnu11 -mmcu=atmega328p -DF_CPU=16000000UL $(AVR_SMALL) -ffunction-sections -fdata-sections $(WARNINGS) \
               $(INCLUDES) -Ihost_tests -I$(BITEXACT) -isystem $(UNITY_DIR)
CHIP_COMMON := $(FILTER_SRC) host_tests/support_filters.c host_tests/support_filter_bounds.c $(BITEXACT)/output.c $(BITEXACT)/output_chip.c
CHIP_OBJ    := $(CHIP_COMMON:%.c=$(U)/tests/%.o) $(U)/tests/host_tests/avr/unity_chip.o $(U)/tests/unity.o
UNITY_CHIP  := -include host_tests/avr/unity_chip.h

$(U)/tests/%.o: %.c Makefile mk/chip_tests.mk
	@mkdir -p $(@D)
	@$(AVR_CC) $(CHIP_FLAGS) -MMD -MP -c $< -o $@

$(U)/tests/host_tests/test_%.o $(U)/tests/host_tests/avr/unity_chip.o: CHIP_FLAGS += $(UNITY_CHIP)

# not gnu11: there Unity takes the macro AVR as a reason to keep its words where it does not read them
$(U)/tests/unity.o: $(UNITY_DIR)/unity.c host_tests/avr/unity_chip.h Makefile mk/chip_tests.mk
	@mkdir -p $(@D)
	@$(AVR_CC) -std=c11 -mmcu=atmega328p $(AVR_SMALL) -ffunction-sections -I$(BITEXACT) $(UNITY_CHIP) -c $< -o $@

$(U)/tests/test_%.elf: $(U)/tests/host_tests/test_%.o $(CHIP_OBJ)
	@$(AVR_CC) $(AVR_LINK) $^ -o $@

$(U)/tests/filter_sequence.elf: $(patsubst %.c,$(U)/tests/%.o,$(SEQUENCE) $(BITEXACT)/output_chip.c $(FILTER_SRC))
	@$(AVR_CC) $(AVR_LINK) $^ -o $@

$(H)/filter_sequence: $(SEQUENCE) $(BITEXACT)/output_pc.c $(FILTER_SRC) $(wildcard lib/*/src/*.h host_tests/*.h $(BITEXACT)/*.h) \
                      Makefile mk/chip_tests.mk
	@mkdir -p $(@D)
	@$(HOST_CC) $(HOST_FLAGS) -O2 $(WARNINGS) $(SANITIZE) -I$(BITEXACT) $(filter %.c,$^) -o $@
