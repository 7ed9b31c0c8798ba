# The judge of the rows is plain C: its test links it without the simulator around it.
$(H)/test_simrun_judge: $(H)/sim/simrun_judge.o
