# Interrupts at the places where main shares data with their handlers.

## race: run each image for MINUTES=10 simulated minutes, with every interrupt served at each instruction that shares data with it (10 minutes)
race:
	@sh tools/deps.sh sim
	@$(MAKE) $(SET_IMAGES) $(S)/simrun
	@python3 campaigns/faults/race.py --minutes $(or $(MINUTES),10)

.PHONY: race
