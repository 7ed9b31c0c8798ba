# Other people's ADXL345 libraries, each with an example sketch of its own, as clients of the sensor model. They are compiled where they are and
# never copied into this repository. INT1 is the pin that goes to D2 here; rates that would take minutes are raised.
PEER_DRIVERS ?= ../shared/peers/drivers
CL           := $(B)/clients
CLIENT_CXX   := $(ARDUINO_CXX) -w -include Arduino.h -I$(ARDUINO_DIR)/libraries/SPI/src
CLIENT_CORE  := $(filter $(A)/core/%,$(ARDUINO_OBJ))
CLIENTS      :=

# CLIENT(name, sketch, folders of its libraries): build/clients/NAME.elf, changed by the sed script ON_NAME
define CLIENT
ifneq ($(wildcard $(PEER_DRIVERS)/$(2)),)
CLIENTS += $(CL)/$(1).elf
endif
$(CL)/$(1).elf: $(PEER_DRIVERS)/$(2) $(CLIENT_CORE) host_tests/system/clients.mk
	@rm -rf $(CL)/$(1) && mkdir -p $(CL)/$(1)
	@sed -nE 's/^(void [A-Za-z]+\([^)]*\)) *\{.*/\1;/p' $$< > $(CL)/$(1)/sketch.cpp
	@sed '$$(ON_$(1))' $$< >> $(CL)/$(1)/sketch.cpp
	@for source in $(wildcard $(3:%=$(PEER_DRIVERS)/%/*.cpp)) $(ARDUINO_DIR)/libraries/SPI/src/SPI.cpp $(CL)/$(1)/sketch.cpp; do \
	    $(CLIENT_CXX) $(3:%=-I$(PEER_DRIVERS)/%) $$$$source -o $(CL)/$(1)/$$$$(basename $$$$source).o || exit 1; done
	@$(AVR_CC) -Os -g -flto -fuse-linker-plugin -Wl,--gc-sections -mmcu=atmega328p $(CL)/$(1)/*.o $(CLIENT_CORE) -lm -o $$@
endef
WE           := ADXL345_WE/examples/ADXL345
ON_adafruit  := s/delay(500)/delay(50)/
ON_sparkfun  := s/^ADXL345 adxl = ADXL345(10).*/ADXL345 adxl;/; s/begin(9600)/begin(115200)/; \
                s/^ *ADXL_ISR();/Serial.print(x); Serial.print(" "); Serial.print(y); Serial.print(" "); Serial.println(z);/
ON_we_check  := s/delay(1000)/delay(100)/
ON_we_ready  := s/INT_PIN_2/INT_PIN_1/; s/RATE_0_20/RATE_100/
ON_we_fifo   := s/INT_PIN_2/INT_PIN_1/; s/RATE_3_13/RATE_100/; s/delay(1000)/delay(10)/
$(eval $(call CLIENT,adafruit,Adafruit_ADXL345/examples/sensortest/sensortest.ino,Adafruit_ADXL345 Adafruit_BusIO Adafruit_Sensor))
$(eval $(call CLIENT,sparkfun,SparkFun_ADXL345/examples/SparkFun_ADXL345_Example/SparkFun_ADXL345_Example.ino,SparkFun_ADXL345/src))
$(eval $(call CLIENT,we_check,$(WE)_basic_data_with_connection_check/ADXL345_basic_data_with_connection_check.ino,ADXL345_WE/src))
$(eval $(call CLIENT,we_ready,$(WE)_data_ready_interrupt/ADXL345_data_ready_interrupt.ino,ADXL345_WE/src))
$(eval $(call CLIENT,we_fifo,$(WE)_fifo_fifo/ADXL345_fifo_fifo.ino,ADXL345_WE/src))

# what make test builds for them: nothing without the drivers or the core
client_images: $(if $(ARDUINO_SRC),$(CLIENTS)) $(S)/simrun

clean: clean_clients
clean_clients:
	@rm -rf $(CL)

.PHONY: client_images clean_clients
