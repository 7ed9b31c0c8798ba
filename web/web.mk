# The demo: one file that runs the firmware in a browser. The worker is packed by esbuild (npm); web/README.md.
W := $(B)/web
DEMO := $(B)/demo/tilt-demo.html
$(W)/worker.js: web/pack.mjs web/package-lock.json second/package-lock.json $(wildcard web/worker/*.mjs) $(addprefix second/,adxl345.mjs board.mjs timer.mjs twowire.mjs uno.mjs varied.mjs)
	@node web/pack.mjs $@

$(DEMO): $(U)/firmware.hex $(W)/worker.js web/demo_page.py tools/tilt/whole_page.py $(wildcard web/*.html web/*.css web/*.js) LICENSE mk/avr-libc.txt
	@python3 web/demo_page.py $(U)/firmware.hex $(W)/worker.js LICENSE $(B)/second/node_modules/avr8js/LICENSE mk/avr-libc.txt $@

## demo: build build/demo/tilt-demo.html, a page that runs the firmware on a simulated UNO in a browser
demo:
	@sh tools/deps.sh firmware
	@sh tools/deps.sh demo
	@$(MAKE) $(DEMO)
	@echo "demo: open $(DEMO) in a browser"

# for its tests, which are skipped where it cannot be built: then no older page may stay (esbuild's program: an optional package of npm)
demo_built: $(if $(and $(wildcard $(W)/node_modules/@esbuild/*/bin),$(wildcard $(B)/second/node_modules/avr8js)),$(DEMO),no_demo)
no_demo: clean_demo

clean: clean_demo
clean_demo:
	@rm -rf $(DEMO) $(W)/worker.js

.PHONY: demo demo_built no_demo clean_demo
