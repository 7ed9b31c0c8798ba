## tilt: install build/venv/bin/tilt, the command for recordings and boards (`build/venv/bin/tilt --help`)
tilt:
	@sh tools/deps.sh tilt
	@echo "tilt: build/venv/bin/tilt --help"

.PHONY: tilt
