# A release: dist/, from a clean tree whose pages of measurements are those of its sources. Archives carry the time of the commit.
# fixed: it is emptied
override DIST := dist
R    := $(B)/release
RELEASE_16MHZ := everyday=$(R)/uno/firmware.hex $(foreach s,$(filter-out everyday,$(FILTER_SETS)),$(s)=$(R)/uno/$(s)/firmware.hex) \
                 small=$(R)/promini/firmware.hex nav=$(R)/uno/nav/firmware.hex
RELEASE_8MHZ  := small=$(R)/promini-8mhz/firmware.hex $(foreach s,$(filter-out everyday,$(FILTER_SETS)),$(s)=$(R)/promini-8mhz/$(s)/firmware.hex)
RELEASE_HEX   := $(subst =,-16mhz=,$(RELEASE_16MHZ)) $(subst =,-8mhz=,$(RELEASE_8MHZ))
RELEASE_DEMO  := $(R)/tilt-demo.html
release_of     = $(filter $(R)/$(1)/%,$(foreach named,$(RELEASE_16MHZ) $(RELEASE_8MHZ),$(lastword $(subst =, ,$(named)))))
# in folders of its own, so that no object of another build gets in
release_make   = $(MAKE) -j2 BOARD=$(1) U=$(R)/$(1) FILTERS=$(2) DEMO=$(RELEASE_DEMO)
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
	@$(call release_make,uno,everyday) $(call release_of,uno) $(RELEASE_DEMO) $(LIBRARY).zip $(LIBTILT_ARGS)
	@$(call release_make,promini,small) $(call release_of,promini)
	@$(call release_make,promini-8mhz,small) $(call release_of,promini-8mhz)
	@python3 mk/scripts/release.py pack $(DIST) "$${SOURCE_DATE_EPOCH:-$$(git log -1 --format=%ct)}" $(LIBTILT_ARGS) $(RELEASE_DEMO) $(LIBRARY).zip $(RELEASE_HEX)

clean: clean_release
clean_release:
	@rm -rf $(DIST) $(R)

.PHONY: release dist clean_release
