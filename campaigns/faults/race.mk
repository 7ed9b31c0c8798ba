# Interrupts where main shares something with their handlers.

## race: each image for MINUTES=10 simulated minutes, every interrupt served at each instruction that shares something with it (10 minutes)
race:
	@sh tools/deps.sh sim
	@$(MAKE) $(SET_IMAGES) $(S)/simrun
	@python3 campaigns/faults/race.py --minutes $(or $(MINUTES),10)

.PHONY: race
