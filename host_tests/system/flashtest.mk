# What make flash does, against the UNO's boot loader in the simulator. Debian ships Optiboot 4.4 as source and as an image, but
# the image is 20 bytes longer than its boot section with this compiler; these options make it fit.
OPTIBOOT_DIR ?= /usr/share/arduino/hardware/arduino/avr/bootloaders/optiboot
OPTIBOOT_CFLAGS := -w -Os -fno-inline -fno-split-wide-types -fno-move-loop-invariants -fno-caller-saves -fno-tree-loop-optimize -mrelax \
                   -mmcu=atmega328p -DF_CPU=16000000L -DLED_START_FLASHES=3 -DBAUD_RATE=115200
OPTIBOOT_LINK   := -Wl,--section-start=.text=0x7e00 -Wl,--section-start=.version=0x7ffe -Wl,--relax -Wl,--gc-sections -nostartfiles -nostdlib

$(U)/optiboot.elf: $(wildcard $(OPTIBOOT_DIR)/optiboot.c) host_tests/system/flashtest.mk
	@mkdir -p $(@D)
	@[ -f $(OPTIBOOT_DIR)/optiboot.c ] || { echo "flashtest: no $(OPTIBOOT_DIR)/optiboot.c: apt-get install arduino-core-avr, or OPTIBOOT_DIR=folder" >&2; exit 1; }
	@$(AVR_CC) $(OPTIBOOT_CFLAGS) $(OPTIBOOT_LINK) $(OPTIBOOT_DIR)/optiboot.c -o $@

$(U)/optiboot.hex: $(U)/optiboot.elf
	@avr-objcopy -j .text -j .data -j .version --set-section-flags .version=alloc,load -O ihex $< $@

# what make test builds for it: without the source the test is skipped
FLASHTEST_IMAGES := $(U)/firmware.hex $(if $(wildcard $(OPTIBOOT_DIR)/optiboot.c),$(U)/optiboot.hex)

## flashtest: write the firmware with avrdude through the UNO's boot loader into the simulated UNO and check that it streams (10 s)
flashtest:
	@sh tools/deps.sh flashtest
	@$(MAKE) flashtest_images
	@python3 host_tests/tools/test_flash.py

flashtest_images: $(FLASHTEST_IMAGES) $(S)/simrun

.PHONY: flashtest flashtest_images
