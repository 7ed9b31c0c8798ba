# A release: dist/, from a clean tree whose pages of measurements are those of its sources. Archives carry the time of the commit.
DIST := dist
RELEASE_16MHZ := everyday=$(B)/uno/firmware.hex $(foreach s,$(filter-out everyday,$(FILTER_SETS)),$(s)=$(B)/uno/$(s)/firmware.hex) \
                 small=$(B)/promini/firmware.hex nav=$(B)/uno/nav/firmware.hex
RELEASE_8MHZ  := small=$(B)/promini-8mhz/firmware.hex \
                 $(foreach s,$(filter-out everyday,$(FILTER_SETS)),$(s)=$(B)/promini-8mhz/$(s)/firmware.hex)
RELEASE_HEX   := $(subst =,-16mhz=,$(RELEASE_16MHZ)) $(subst =,-8mhz=,$(RELEASE_8MHZ))
release_of     = $(filter $(B)/$(1)/%,$(foreach named,$(RELEASE_16MHZ) $(RELEASE_8MHZ),$(lastword $(subst =, ,$(named)))))
# what the wheel's C is compiled with where it is first used
LIBTILT_ARGS  := $(B)/release/libtilt.args

$(U)/%/firmware.hex: $(U)/%/firmware.elf
	@avr-objcopy -O ihex -R .eeprom $< $@

$(LIBTILT_ARGS): $(LIBTILT_SRC) Makefile tools/tilt/tilt.mk mk/release.mk mk/host.mk
	@mkdir -p $(@D)
	@echo '$(filter-out -O1 -g -isystem $(UNITY_DIR),$(HOST_FLAGS)) -O2 -fPIC -shared -fvisibility=hidden $(LIBTILT_SRC) -lm' > $@

## release: build dist/: images, demo, Arduino library, wheel of tilt, simulator, checksums, notes (fails on stale pages; docs/developing.md)
release:
	@python3 mk/scripts/release.py judge
	@$(MAKE) check-pages STRICT=yes
	@$(MAKE) dist

# the same of any tree, unjudged
dist:
	@sh tools/deps.sh firmware demo
	@$(MAKE) -j2 BOARD=uno FILTERS=everyday $(call release_of,uno) $(LIBRARY).zip $(DEMO) $(LIBTILT_ARGS)
	@$(MAKE) -j2 BOARD=promini FILTERS=small $(call release_of,promini)
	@$(MAKE) -j2 BOARD=promini-8mhz FILTERS=small $(call release_of,promini-8mhz)
	@python3 mk/scripts/release.py pack $(DIST) "$${SOURCE_DATE_EPOCH:-$$(git log -1 --format=%ct)}" $(LIBTILT_ARGS) $(DEMO) $(LIBRARY).zip $(RELEASE_HEX)

clean: clean_release
clean_release:
	@rm -rf $(DIST) $(B)/release

.PHONY: release dist clean_release
