# The experiments of the papers: double references and the shipped fixed-point code over the same realisations.
P := $(B)/papers
PAPERS_C   := $(wildcard lib/filters/src/*.c) $(LAW_SUPPORT) host_tests/support/random.c host_tests/support/tilt_phases.c
PAPERS_OBJ := $(PAPERS_C:%.c=$(P)/%.o) $(addprefix $(P)/host_tests/papers/,model.o statistics.o)
PROGRAM    := $(addprefix $(P)/host_tests/papers/,program.o report.o)
RUNS ?= 10000
PAPER_SEED ?= 2024

$(P)/%.o: %.cpp Makefile campaigns/papers/papers.mk
	@mkdir -p $(@D)
	@$(HOST_CXX) -std=c++17 -O3 -fPIC -fno-semantic-interposition -DEIGEN_NO_DEBUG -g -Wall -Wextra -Wconversion -Wshadow -Werror -Ihost_tests -Inav/tests -Ilib/machine/src -Ilib/filters/src -isystem /usr/include/eigen3 -MMD -MP -c $< -o $@

$(P)/%.o: %.c Makefile campaigns/papers/papers.mk
	@mkdir -p $(@D)
	@$(HOST_CC) $(HOST_FLAGS) -O3 -fPIC -fno-semantic-interposition $(WARNINGS) -MMD -MP -c $< -o $@

# papers 000, 001 and 002 are in Python (campaigns/synthesis, campaigns/resilience) over this
BATCH := $(P)/libbatch.so
$(BATCH): $(addprefix $(P)/host_tests/,papers/batch.o papers/contest.o $(addprefix reference/,noise.o robust.o synthesis.o)) $(PAPERS_OBJ)
	@$(HOST_CXX) -shared $^ -lm -o $@

$(P)/paper004_board: $(P)/host_tests/papers/paper004_board.o $(PROGRAM) $(PAPERS_OBJ)
	@$(HOST_CXX) $^ -lm -o $@

# paper 003 asks nav/lib, not the filters
NAV_PAPER := $(patsubst %.cpp,$(P)/%.o,$(wildcard host_tests/papers/navigation/*.cpp)) $(PROGRAM) $(addprefix $(P)/host_tests/papers/,model.o statistics.o) \
             $(addprefix $(P)/nav/tests/,reference_nav.o nav_flights.o nav_histories.o) $(addprefix $(P)/host_tests/support/,flight.o random.o) $(NAV_VARIANTS:%=$(P)/nav/%.o)
$(foreach variant,$(NAV_VARIANTS),$(eval $(call nav_variant,$(variant),$(P))))
$(P)/paper003: $(P)/host_tests/papers/paper003.o $(NAV_PAPER)
	@$(HOST_CXX) $^ -lm -o $@

# paper 002's filters again, as C++ with integers that count operations: the compiler names whatever does not fit them
OPERATIONS := host_tests/papers/operations
LISTED     := $(shell sed -n 's/^ *X(\([a-z0-9_]*\)).*/\1/p' lib/filters/src/filter.h)
NOT_002    := $(filter-out $(shell python3 mk/scripts/laws.py kalman),$(LISTED))
ONLY_002   := -D'FILTER_LIST(X)=$(foreach f,$(filter-out $(NOT_002),$(LISTED)),X($f))'
COUNTED    := $(patsubst lib/filters/src/%.c,$(P)/operations/%.o,$(filter-out $(NOT_002:%=lib/filters/src/%.c) $(NOT_002:%=lib/filters/src/%_%.c),$(wildcard lib/filters/src/*.c)))
COUNT_CXX  := $(HOST_CXX) -std=gnu++20 -O0 -Ilib/machine/src -Ilib/filters/src -I$(OPERATIONS) -Ihost_tests/papers $(ONLY_002)
$(P)/operations/fx.o: COUNT_CXX += -DCOUNTING_PRIMITIVES

$(P)/operations/%.o: lib/filters/src/%.c $(wildcard lib/filters/src/*.h) $(MACHINE_H) $(OPERATIONS)/counting.hpp Makefile campaigns/papers/papers.mk
	@mkdir -p $(@D)
	@sed -E 's/\[([^][]+)\]/[counting::index(\1)]/g; 1s|^|#line 1 "$<"\n|' $< | $(COUNT_CXX) -include $(OPERATIONS)/counting.hpp -x c++ -c - -o $@

$(P)/operations/main.o: $(OPERATIONS)/main.cpp $(wildcard lib/filters/src/*.h) $(MACHINE_H) $(OPERATIONS)/counting.hpp Makefile campaigns/papers/papers.mk
	@mkdir -p $(@D)
	@$(COUNT_CXX) -Wall -Wextra -Werror -c $< -o $@

$(P)/operations/state_bytes.o: $(OPERATIONS)/state_bytes.c $(OPERATIONS)/state_bytes.h host_tests/bitexact/packed_states.h $(wildcard lib/*/src/*.h) Makefile campaigns/papers/papers.mk
	@mkdir -p $(@D)
	@$(HOST_CC) $(HOST_FLAGS) $(ONLY_002) -Ihost_tests -I$(OPERATIONS) $(WARNINGS) -c $< -o $@

$(P)/operations002: $(COUNTED) $(P)/operations/main.o $(P)/operations/state_bytes.o
	@$(HOST_CXX) $^ -lm -o $@

# and the synthesised filters, whose headers state the products per sample
$(P)/operations/family.o: $(OPERATIONS)/family.cpp $(wildcard lib/filters/src/*.h) $(MACHINE_H) $(OPERATIONS)/counting.hpp Makefile campaigns/papers/papers.mk
	@mkdir -p $(@D)
	@$(COUNT_CXX) -Wall -Wextra -Werror -c $< -o $@

$(P)/products000: $(addprefix $(P)/operations/,family.o filter.o tracker.o parameters.o fx.o) $(patsubst lib/filters/src/%.c,$(P)/operations/%.o,$(wildcard lib/filters/src/synth*.c))
	@$(HOST_CXX) $^ -lm -o $@

PAPERS := $(BATCH) $(P)/paper003 $(P)/paper004_board $(P)/operations002 $(P)/products000
paper_programs: $(PAPERS)

## papers: run the papers' experiments, double and fixed point, beside the printed numbers, into docs/results/papers-*.md (6 minutes; RUNS=2000, PAPER_SEED=2025: judges only)
papers:
	@sh tools/deps.sh papers
	@$(MAKE) -j2 paper_programs
	@python3 campaigns/papers/papers.py --runs $(RUNS) --seed $(PAPER_SEED)

clean: clean_papers
clean_papers:
	@rm -rf $(P)

.PHONY: papers paper_programs clean_papers

-include $(shell find $(P) -name '*.d' 2>/dev/null)
