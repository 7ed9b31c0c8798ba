# The images of the firmware: which filters are in them, and those that tests need besides.

# Not all filters fit into 32 KB. FILTERS is one of these sets, or names from lib/filters/src/filter.h; the firmware starts with
# the first. The first set is built and flashed by default; together the sets hold every filter.
FILTER_SETS          := everyday soft research models auto
FILTERS_everyday     := adaptive sprf kf synth
FILTERS_soft         := soft lrf synth_opt
FILTERS_research     := pbf sprf_paper shrf af
FILTERS_models       := synth_plus kf3
FILTERS_auto         := auto
# fewer, all of them in the first set too: for boards whose boot loader leaves less flash than the UNO's
FILTERS_small        := adaptive synth
FILTERS              := $(if $(filter 32256,$(BOARD_FLASH)),$(firstword $(FILTER_SETS)),small)
SAY_FILTERS          := $(if $(filter-out 32256,$(BOARD_FLASH)),$(if $(filter small,$(FILTERS)),echo "BOARD=$(BOARD) has $(BOARD_FLASH) bytes of flash: the image holds the set small ($(FILTERS_small)); choose others with FILTERS=",:),:)

CHOSEN_FILTERS := $(or $(FILTERS_$(strip $(FILTERS))),$(FILTERS))
IMAGE_FILTERS   = $(FILTERS_everyday)
ELSEWHERE       = $(filter-out $(IMAGE_FILTERS),$(foreach s,$(FILTER_SETS),$(FILTERS_$(s))))
FILTER_FLAG     = '-DFILTER_LIST(X)=$(foreach f,$(IMAGE_FILTERS),X($(f)))' \
                  $(if $(ELSEWHERE),'-DFILTERS_ELSEWHERE(X)=$(foreach f,$(ELSEWHERE),X($(f)))') \
                  $(if $(filter auto,$(IMAGE_FILTERS)),-DSUPERVISOR=1,-DFILTER_WITHOUT_PROBE)

# the image that holds a filter: the chosen one if it does, else that of the first set that does
image_with = $(or $(firstword $(if $(filter $(1),$(CHOSEN_FILTERS)),$(U)/firmware.elf) \
             $(foreach s,$(FILTER_SETS),$(if $(filter $(1),$(FILTERS_$(s))),$(U)/$(s)/firmware.elf))), \
             $(error FILTER: no image holds a filter $(1); filters: $(sort $(foreach s,$(FILTER_SETS),$(FILTERS_$(s))))))

# the chosen one is rebuilt when the choice changes
$(AVR_OBJ) $(U)/filters.txt $(U)/firmware.elf: IMAGE_FILTERS = $(CHOSEN_FILTERS)
$(AVR_OBJ): $(U)/filters.txt
$(U)/filters.txt: FORCE
	@sh mk/scripts/filters_txt.sh $@ $(IMAGE_FILTERS)

$(U)/%.o: %.c Makefile mk/images.mk
	@mkdir -p $(@D)
	@$(AVR_CC) $(AVR_FLAGS) -MMD -MP -c $< -o $@

$(U)/firmware.elf: $(AVR_OBJ) $(UNO_LD)
	@python3 mk/scripts/link_image.py $(BOARD) $(BOARD_FLASH) "$(IMAGE_FILTERS)" $(AVR_CC) $(AVR_LINK) -Wl,-Map,$(U)/firmware.map $(AVR_OBJ) -o $@
	@echo "built $@"

# IMAGE(name, filters, further flags): build/uno/NAME/firmware.elf, and filters.txt, which lists its filters
define IMAGE
$(U)/$(1)/%: IMAGE_FILTERS = $(2)
$(U)/$(1)/%.o: %.c Makefile mk/images.mk
	@mkdir -p $$(@D)
	@$$(AVR_CC) $$(AVR_FLAGS) $(3) -MMD -MP -c $$< -o $$@

$(U)/$(1)/filters.txt: Makefile mk/images.mk
	@sh mk/scripts/filters_txt.sh $$@ $$(IMAGE_FILTERS)

$(U)/$(1)/firmware.elf: $(AVR_SRC:%.c=$(U)/$(1)/%.o) $(UNO_LD) | $(U)/$(1)/filters.txt
	@$$(AVR_CC) $$(AVR_LINK) $$(filter %.o,$$^) -o $$@
endef

# the sets; that of everyday only if another one was chosen
$(foreach s,$(FILTER_SETS),$(eval $(call IMAGE,$(s),$(FILTERS_$(s)))))
# its stages can be stopped one by one; fewer filters, to make room: it also runs after a boot loader
$(eval $(call IMAGE,hang,$(FILTERS_small),-DHANG_TEST=1))
# the clock starts shortly before its wrap; at ten digits
$(eval $(call IMAGE,wrap,$(FILTERS_everyday),-DHAL_TIME_START_US=4289967296ul))
$(eval $(call IMAGE,late,$(FILTERS_research),-DHAL_TIME_START_US=4200000000ul))
# built for a slower processor: its sample period is short for a filter
$(eval $(call IMAGE,tight,$(FILTERS_research),-DHAL_CPU_HZ=15500000ul))

# as the first, but accepts its readings unchecked: the difference is the cost of checking them
PLAIN_OBJ := $(AVR_SRC:%.c=$(U)/plain/%.o) $(U)/plain/host_tests/chip/plain_read.o
$(U)/plain/%.o: AVR_FLAGS += -Dadxl345_integrity_judge=plain_judge
$(U)/plain/lib/adxl345/src/adxl345_integrity.o: AVR_FLAGS += -Uadxl345_integrity_judge
$(U)/plain/%.o: %.c Makefile mk/images.mk
	@mkdir -p $(@D)
	@$(AVR_CC) $(AVR_FLAGS) -MMD -MP -c $< -o $@

$(U)/plain/firmware.elf: $(PLAIN_OBJ) $(UNO_LD)
	@$(AVR_CC) $(AVR_LINK) $(PLAIN_OBJ) -o $@

SET_IMAGES      := $(U)/firmware.elf $(patsubst %,$(U)/%/firmware.elf,$(filter-out everyday,$(FILTER_SETS)))
FIRMWARE_IMAGES := $(SET_IMAGES) $(patsubst %,$(U)/%/firmware.elf,hang wrap late tight plain)

# the image of a board with half the clock, as make firmware builds it
SLOW_IMAGE      := $(B)/promini-8mhz/firmware.elf
ifneq ($(U)/firmware.elf,$(SLOW_IMAGE))
$(SLOW_IMAGE): FORCE
	@$(MAKE) BOARD=promini-8mhz U=$(@D) FILTERS=small $@
endif

FORCE:
.PHONY: FORCE
