# The firmware's images under avr8js (npm), with an ADXL345 written from the data sheet: second/README.md.

X := $(B)/second
SECOND_IMAGES := $(SET_IMAGES:.elf=.hex)

$(U)/%/firmware.hex: $(U)/%/firmware.elf
	@avr-objcopy -O ihex -R .eeprom $< $@

# Planted faults. PLANT(name, source, sed's command): the source with one change, in a folder of its own; sed must find its place.
define PLANT
$(X)/planted/$(1)/$(notdir $(2)): $(2) second/second.mk
	@mkdir -p $$(@D)
	@sed '$(3)' $$< > $$@
	@! cmp -s $$< $$@ || { echo "second: planted fault $(1): its place in $(2) is gone" >&2; rm $$@; exit 1; }
endef

# the shipped image with one source changed
define PLANT_FIRMWARE
$(call PLANT,firmware/$(1),$(2),$(3))
$(X)/planted/firmware/$(1)/plant.o: IMAGE_FILTERS = $(CHOSEN_FILTERS)
$(X)/planted/firmware/$(1)/plant.o: $(X)/planted/firmware/$(1)/$(notdir $(2)) $(U)/filters.txt Makefile mk/images.mk second/second.mk
	@$$(AVR_CC) $$(AVR_FLAGS) -I$(dir $(2)) -MMD -MP -c $$< -o $$@

$(X)/planted/firmware/$(1)/firmware.elf: $(X)/planted/firmware/$(1)/plant.o $(AVR_OBJ)
	@$$(AVR_CC) $$(AVR_LINK) $$(filter-out $(U)/$(2:.c=.o) $(U)/filters.txt,$$^) -o $$@

$(X)/planted/firmware/$(1)/firmware.hex: $(X)/planted/firmware/$(1)/firmware.elf
	@avr-objcopy -O ihex -R .eeprom $$< $$@
SECOND_PLANTED += $(X)/planted/firmware/$(1)/firmware.hex
endef

# simrun with one source changed
SECOND_SIM_OBJ := $(SIMRUN_SRC:%.c=$(X)/%.o)
$(X)/sim/%.o: sim/%.c Makefile mk/host.mk second/second.mk
	@mkdir -p $(@D)
	@$(SIM_CC) -MMD -MP -c $< -o $@

define PLANT_SIMRUN
$(call PLANT,simrun/$(1),$(2),$(3))
$(X)/planted/simrun/$(1)/plant.o: $(X)/planted/simrun/$(1)/$(notdir $(2)) Makefile mk/host.mk second/second.mk
	@$$(SIM_CC) -MMD -MP -c $$< -o $$@

$(X)/planted/simrun/$(1)/simrun: $(X)/planted/simrun/$(1)/plant.o $(SECOND_SIM_OBJ)
	@$$(SIM_CC) $$(filter-out $(X)/$(2:.c=.o),$$^) $$$$(pkg-config --libs simavr) -lsimavrparts -lelf -lm -lpthread -lutil -o $$@
SECOND_PLANTED += $(X)/planted/simrun/$(1)/simrun
endef

$(eval $(call PLANT_FIRMWARE,bytes_swapped,lib/adxl345/src/adxl345_integrity.c,s/(low | (uint16_t)((uint16_t)high << 8))/(high | (uint16_t)((uint16_t)low << 8))/))
$(eval $(call PLANT_FIRMWARE,ten_bits,lib/adxl345/src/adxl345_table.c,s/ADXL345_FORMAT_FULL_RES | force/force/))
$(eval $(call PLANT_FIRMWARE,guard_of_2_75_sigma,lib/filters/src/adaptive.c,s/\(4096.\) 1152/\1 1056/;s/= 768;/= 704;/))
$(eval $(call PLANT_FIRMWARE,clock_a_thousandth_slow,hal/avr/hal_time.c,s/hal_tick.us += HAL_TICK_US;/hal_tick.us += HAL_TICK_US - 8;/))
$(eval $(call PLANT_SIMRUN,bytes_alike,sim/model/adxl345_model.c,s/2 \* axis\] = (uint8_t)word;/2 * axis] = (uint8_t)(word >> 8);/))
$(eval $(call PLANT_SIMRUN,fifo_of_30,sim/model/adxl345_model.c,s/ADXL345_MODEL_FIFO_DEPTH/(ADXL345_MODEL_FIFO_DEPTH - 3)/))
$(eval $(call PLANT_SIMRUN,never_pops,sim/model/adxl345_model.c,s/(uint8_t)(m->fifo_count - 1)/m->fifo_count/))
$(eval $(call PLANT_SIMRUN,rate_of_3100_hz,sim/model/adxl345_model.c,s/return 3200\.0/return 3100.0/))

second_built: $(SECOND_IMAGES) $(S)/simrun $(H)/native_replay $(H)/pipeline_replay $(SECOND_PLANTED)

## second: compare the images under avr8js and a second sensor model with simrun and the PC, into build/second.json (PART=ci: a part in turn; ONLY=rows,planted)
second:
	@sh tools/deps.sh bench
	@sh tools/deps.sh second; status=$$?; \
	if [ $$status -eq 3 ]; then \
	    echo "skipped: 1 (make second: Node or avr8js is missing or too old and could not be installed, see above)"; echo "0 passed, 0 failed"; \
	elif [ $$status -ne 0 ]; then echo "0 passed, 1 failed"; exit 1; \
	else node --test --test-reporter=dot second/test.mjs && $(MAKE) -j2 second_built && \
	    PART='$(PART)' ONLY='$(ONLY)' PLANTED='$(SECOND_PLANTED)' COUNT=$(shell git rev-list --count HEAD 2>/dev/null || echo 0) node second/run.mjs $(FILTER_SETS); fi

# npm's downloads stay
clean: clean_second
clean_second:
	@rm -rf $(X)/planted $(X)/sim $(X)/run-*

.PHONY: second second_built clean_second

-include $(shell find $(X)/planted $(X)/sim -name '*.d' 2>/dev/null)
