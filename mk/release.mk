# A release: dist/, from a clean tree whose pages of measurements are those of its sources. Archives carry the time of the commit.
# fixed: it is emptied
override DIST := dist
R    := $(B)/release
RELEASE_16MHZ := everyday=$(B)/uno/firmware.hex $(foreach s,$(filter-out everyday,$(FILTER_SETS)),$(s)=$(B)/uno/$(s)/firmware.hex) \
                 small=$(B)/promini/firmware.hex nav=$(B)/uno/nav/firmware.hex
RELEASE_8MHZ  := small=$(B)/promini-8mhz/firmware.hex $(foreach s,$(filter-out everyday,$(FILTER_SETS)),$(s)=$(B)/promini-8mhz/$(s)/firmware.hex)
RELEASE_HEX   := $(subst =,-16mhz=,$(RELEASE_16MHZ)) $(subst =,-8mhz=,$(RELEASE_8MHZ))
release_of     = $(filter $(B)/$(1)/%,$(foreach named,$(RELEASE_16MHZ) $(RELEASE_8MHZ),$(lastword $(subst =, ,$(named)))))
release_make   = $(MAKE) -j2 BOARD=$(1) FILTERS=$(2) $(release_of)
# what the wheel's C is compiled with where it is first used
LIBTILT_ARGS  := $(R)/libtilt.args

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
	@$(call release_make,uno,everyday) $(DEMO) $(LIBRARY).zip $(LIBTILT_ARGS)
	@$(call release_make,promini,small)
	@$(call release_make,promini-8mhz,small)
	@python3 mk/scripts/release.py pack $(DIST) "$${SOURCE_DATE_EPOCH:-$$(git log -1 --format=%ct)}" $(LIBTILT_ARGS) $(DEMO) $(LIBRARY).zip $(RELEASE_HEX)

clean: clean_release
clean_release:
	@rm -rf $(DIST) $(R)

.PHONY: release dist clean_release
