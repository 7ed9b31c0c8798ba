# What is refused before anything is built; tools/sim.sh and mk/scripts/misspelt.py refuse the rest.

# a wrong name in FILTERS, before a port is looked for
firmware flash: | known_filters
known_filters:
	@sh mk/scripts/filters_txt.sh /dev/null $(CHOSEN_FILTERS)

# nothing is said of what is up to date
sim: MAKE += -s

.PHONY: known_filters
