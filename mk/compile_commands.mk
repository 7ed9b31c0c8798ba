COMPILE_COMMANDS ?= compile_commands.json
COMPILED_TARGETS = $(TESTS) $(H)/exhaustive_isqrt system_images paper_programs $(SEQUENCES) $(CHIP_TESTS) $(BENCH_IMAGES) $(FUZZ_BIN) $(NAV_TESTED) \
                   $(H)/recordings $(H)/default_filter

## compile_commands: write compile_commands.json for clangd: how every source is compiled, for the PC and for the chip
compile_commands:
	@WARNINGS="$(WARNINGS)" UNITY_DIR="$(UNITY_DIR)" python3 mk/scripts/compile_commands.py --out $(COMPILE_COMMANDS) $(COMPILED_TARGETS)

.PHONY: compile_commands
