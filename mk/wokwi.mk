# Wokwi: a project with the sensor model as a custom chip. Its own API is a header of ours on the PC, host_tests/sim/wokwi-api.h.
$(H)/wokwi/%.o $(H)/host_tests/sim/test_wokwi.o: HOST_FLAGS += -Ihost_tests/sim
$(H)/test_wokwi: $(H)/wokwi/adxl345.chip.o

## wokwi: build build/wokwi, a project for the Wokwi simulator: the firmware and the sensor model as a custom chip (wokwi/README.md)
wokwi:
	@sh tools/deps.sh firmware
	@$(MAKE) $(U)/firmware.hex
	@python3 mk/scripts/wokwi.py $(B)/wokwi $(U)/firmware.elf $(U)/firmware.hex
	@echo "wokwi: the project is in $(B)/wokwi"

clean: clean_wokwi
clean_wokwi:
	@rm -rf $(B)/wokwi

.PHONY: wokwi clean_wokwi
