# lib/filters and lib/tilt as one library for the Arduino IDE and PlatformIO, and its example sketches with the Arduino core (Debian: arduino-core-avr 1.8.7), flags as platform.txt
# of the core has them (-isystem would make its headers C for this compiler). DECIMAL_DIG: avr-gcc 5.4.0 defines it only with its underscores in C++11, and WString.cpp wants it.
ARDUINO_DIR ?= /usr/share/arduino/hardware/arduino/avr
A := $(B)/arduino
ARDUINO_FLAGS := -c -g -Os -flto -ffunction-sections -fdata-sections -MMD -MP -mmcu=atmega328p -DF_CPU=16000000L -DARDUINO=10819 \
                 -DARDUINO_AVR_UNO -DARDUINO_ARCH_AVR -DDECIMAL_DIG=__DECIMAL_DIG__ \
                 $(addprefix -I$(ARDUINO_DIR)/,cores/arduino variants/standard libraries/Wire/src libraries/Wire/src/utility)
ARDUINO_C   := $(AVR_CC) -std=gnu11 $(ARDUINO_FLAGS)
ARDUINO_CXX := avr-g++ -std=gnu++11 -fpermissive -fno-exceptions -fno-threadsafe-statics $(ARDUINO_FLAGS)
ARDUINO_SRC := $(wildcard $(addprefix $(ARDUINO_DIR)/,cores/arduino/*.c cores/arduino/*.cpp libraries/Wire/src/*.cpp libraries/Wire/src/utility/*.c))
LIBRARY     := $(B)/library/tilt-filters
LIBRARY_OF  := $(shell find lib/filters -type f) $(wildcard lib/tilt/src/*.[ch] lib/machine/src/*.h) firmware/console/version.h
LIBRARY_SRC := $(notdir $(wildcard lib/filters/src/*.c lib/tilt/src/*.c))
ARDUINO_OBJ := $(patsubst $(ARDUINO_DIR)/%,$(A)/core/%.o,$(ARDUINO_SRC)) $(LIBRARY_SRC:%.c=$(A)/library/%.o)
SKETCHES    := $(wildcard lib/filters/examples/*/*.ino)
# what make test builds for it: without the core the sketches are skipped
ARDUINO_IMAGES := $(LIBRARY).zip $(A)/libtiltfilters.so $(if $(ARDUINO_SRC),$(SKETCHES:lib/filters/examples/%.ino=$(A)/%.elf))

$(LIBRARY).zip: $(LIBRARY_OF) mk/scripts/library.py mk/scripts/packed.py
	@python3 mk/scripts/library.py $(@D)

$(A)/core/%.c.o: $(ARDUINO_DIR)/%.c mk/arduino.mk
	@mkdir -p $(@D)
	@$(ARDUINO_C) -w $< -o $@

$(A)/core/%.cpp.o: $(ARDUINO_DIR)/%.cpp mk/arduino.mk
	@mkdir -p $(@D)
	@$(ARDUINO_CXX) -w $< -o $@

$(A)/library/%.o: $(LIBRARY).zip mk/arduino.mk
	@mkdir -p $(@D)
	@$(ARDUINO_C) -Wall -Wextra -Werror $(LIBRARY)/src/$*.c -o $@

# a sketch is C++ after Arduino.h
$(A)/%.ino.o: $(LIBRARY).zip mk/arduino.mk
	@mkdir -p $(@D)
	@$(ARDUINO_CXX) -Wall -Wextra -Werror -I$(LIBRARY)/src -include Arduino.h -x c++ $(LIBRARY)/examples/$*.ino -o $@

$(A)/%.elf: $(A)/%.ino.o $(ARDUINO_OBJ)
	@$(AVR_CC) -Os -g -flto -fuse-linker-plugin -Wl,--gc-sections -mmcu=atmega328p $^ -lm -o $@

# the same library on the PC, for the output expected of the sketches
$(A)/libtiltfilters.so: $(LIBRARY).zip mk/arduino.mk
	@mkdir -p $(@D)
	@$(HOST_CC) -std=c11 -O2 $(WARNINGS) -fPIC -shared $(LIBRARY)/src/*.c -o $@

## arduino: build build/library/tilt-filters.zip, a library for the Arduino IDE and PlatformIO; run its sketches in the simulated UNO (1 minute)
arduino:
	@sh tools/deps.sh arduino
	@$(MAKE) $(LIBRARY).zip
	@python3 host_tests/tools/scripts/arduino_rules.py $(LIBRARY) lib/filters
	@$(MAKE) arduino_images
	@python3 host_tests/tools/scripts/test_arduino.py

arduino_images: $(ARDUINO_IMAGES) $(S)/simrun

clean: clean_arduino
clean_arduino:
	@rm -rf $(A) $(B)/library

.PHONY: arduino arduino_images clean_arduino

-include $(shell find $(A) -name '*.d' 2>/dev/null)
