# Faults in simrun: the campaign, and random faults for hours.

## faults: inject every fault at every phase, and every pair, into build/faults.json and docs/results/faults-campaign.md (8,700 runs, 12 to 22 minutes; SAMPLE=300: a sample)
faults:
	@sh tools/deps.sh sim
	@$(MAKE) $(U)/firmware.elf $(S)/simrun
	@python3 campaigns/faults/faults.py $(if $(SAMPLE),--sample '$(SAMPLE)' --seed $(shell git rev-list --count HEAD 2>/dev/null || echo 1))

## soak: simulate hours with random faults, in two halves side by side (HOURS=24: about 10 minutes on two cores)
soak:
	@sh tools/deps.sh sim
	@$(MAKE) $(U)/firmware.elf $(S)/simrun
	@python3 campaigns/faults/soak.py --hours $(or $(HOURS),24)

.PHONY: faults soak
