# The filters' outputs as committed: host_tests/filters/golden.
GOLDEN := host_tests/filters/golden

$(H)/golden_vectors: $(GOLDEN)/golden_vectors.c $(wildcard lib/filters/src/*.c lib/filters/src/*.h) $(MACHINE_H) $(LAW_SUPPORT) \
                     host_tests/support/random.c Makefile host_tests/filters/golden.mk
	@mkdir -p $(@D)
	@$(HOST_CC) $(HOST_FLAGS) $(WARNINGS) $(SANITIZE) $(filter %.c,$^) -lm -o $@

## golden: write the filters' vectors (host_tests/filters/golden) again, after an intended change of their bits
golden: $(H)/golden_vectors
	@$(H)/golden_vectors > $(GOLDEN)/filters_100hz.csv.part && mv $(GOLDEN)/filters_100hz.csv.part $(GOLDEN)/filters_100hz.csv
	@git diff --stat -- $(GOLDEN) 2>/dev/null || true

.PHONY: golden
