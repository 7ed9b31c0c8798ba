# Tests whose result may depend on the machine's load.

ROUNDS ?= 10
LOAD   ?= 8
## loaded: run the tests of browser, port, boot loader and live processes ROUNDS=10 times under LOAD=8 busy loops (30 minutes; after make test; ONLY=tilt_record_sent: a part)
loaded:
	@python3 campaigns/loaded.py --rounds $(ROUNDS) --load $(LOAD) $(ONLY)

## desk: run the timing tests that need an idle machine: tilt live and the demo, first picture, rows/s in real time (3 minutes)
desk:
	@sh tools/deps.sh tilt
	@sh tools/deps.sh live
	@$(MAKE) $(S)/simrun $(U)/firmware.elf
	@$(PY) host_tests/tools/tilt/desk_live.py
	@sh tools/deps.sh demo
	@$(MAKE) demo_built
	@$(PY) host_tests/tools/web/desk_demo.py

.PHONY: loaded desk
