# The papers' figures, drawn from our runs. The name sorts this file behind papers.mk, whose variables it uses.
TRACES := $(P)/libtraces.so
$(TRACES): $(addprefix $(P)/host_tests/,papers/figures/traces.o tools/comparison/peer_traces.o support/peers.o support/robust_peers.o support/chain.o reference/robust.o reference/robust_joint.o) $(PAPERS_OBJ)
	@$(HOST_CXX) -shared $^ -lm -o $@

$(P)/flight_series: $(P)/host_tests/papers/figures/flight_series.o $(addprefix $(P)/nav/tests/,reference_nav.o nav_flights.o) \
                    $(addprefix $(P)/host_tests/support/,flight.o random.o) $(NAV_VARIANTS:%=$(P)/nav/%.o)
	@$(HOST_CXX) $^ -lm -o $@

## figures: draw the papers' figures from our own runs, into docs/results/paper-figures.md (1 minute; make papers FIGURES=yes does it first)
figures:
	@sh tools/deps.sh papers
	@$(MAKE) -j2 $(BATCH) $(TRACES) $(P)/flight_series
	@$(PY) campaigns/papers/figures.py

ifneq ($(FIGURES),)
papers: figures
endif

.PHONY: figures

paper_programs: $(TRACES) $(P)/flight_series
