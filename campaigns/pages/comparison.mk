# Ours beside what the literature and other people's toolboxes have, on the same samples.
FUSION      := $(wildcard $(PEERS)/Fusion/Fusion)
FUSION_C    := $(if $(FUSION),$(addprefix $(FUSION)/,FusionAhrs.c))
FUSION_INC   = -I$(FUSION) -Ihost_tests -Ihost_tests/tools/comparison
FUSION_BUILT := $(if $(FUSION),$(H)/default_filter_fusion $(B)/papers/libfusion.so)

# the class table's program with one contender more: the library, where it is there
$(H)/default_filter_fusion: host_tests/tools/campaigns/default_filter.c host_tests/tools/comparison/fusion_pc.h host_tests/tools/comparison/runner.h $(FUSION_C) $(ARCHIVES_O2) $(PAPER_AXES_O2)
	@$(HOST_CC) $(HOST_FLAGS) -O2 -DPEER_FUSION $(FUSION_INC) $< $(FUSION_C) $(call linked,$(ARCHIVES_O2) $(PAPER_AXES_O2)) -lm -lstdc++ -o $@

$(B)/papers/libfusion.so: host_tests/tools/comparison/fusion_traces.c host_tests/tools/comparison/fusion_pc.h $(FUSION_C)
	@mkdir -p $(@D)
	@$(HOST_CC) -std=c11 -O2 -fPIC -shared $(FUSION_INC) $< $(FUSION_C) -lm -o $@

## comparison: measure ours beside other filters: accuracy, lag, cycles, flash, among outliers (PEERS=folder), into docs/results/comparison.md (2 minutes)
comparison:
	@sh tools/deps.sh papers
	@$(MAKE) -j2 $(H)/default_filter $(B)/papers/libtraces.so $(S)/simrun $(FUSION_BUILT)
	@test -f $(B)/default.json || $(MAKE) default
	@$(PY) campaigns/pages/comparison.py --flags '$(BENCH_COMMON) -Wl,--gc-sections $(BENCH_INC) -Ihost_tests' --sources '$(BENCH_SRC)' --peers '$(PEERS)'

.PHONY: comparison
