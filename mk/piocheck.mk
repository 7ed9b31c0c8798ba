# PlatformIO: its Core comes from PyPI; its packages are not available from every network, so others stand in for them.

## piocheck: build platformio.ini with PlatformIO Core and stand-in packages (1 minute)
piocheck:
	@sh tools/deps.sh test piocheck
	@python3 mk/scripts/pio_standins.py build/pio/core build/venv-pio
	@$(MAKE) $(U)/firmware.elf $(S)/simrun $(H)/native_replay $(LIBRARY).zip
	@python3 host_tests/tools/scripts/test_platformio.py

.PHONY: piocheck
