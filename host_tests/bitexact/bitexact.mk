# The same bits from every compiler and on the chip.

## bitexact: compare every filter, angle and number on PC and chip, all optimisations, bit for bit (30 s)
bitexact:
	@sh tools/deps.sh test
	@$(MAKE) $(S)/simrun
	@WARNINGS="$(WARNINGS)" AVR_SMALL="$(AVR_SMALL)" CHIP_SECOND="$(CHIP_SECOND)" python3 campaigns/tests/bitexact.py

.PHONY: bitexact
