# Boards with an ATmega328P: the row of mk/boards.txt that BOARD names.
BOARD  ?= uno
BOARDS := $(shell awk '!/^\#/ { print $$1 }' mk/boards.txt)
$(if $(filter 1,$(words $(filter $(BOARD),$(BOARDS)))),,$(error BOARD: no board '$(BOARD)': choose from $(BOARDS)))
BOARD_FACTS  := $(shell awk '$$1 == "$(BOARD)"' mk/boards.txt)
BOARD_FLASH  := $(word 3,$(BOARD_FACTS))
CPU_HZ       := $(word 4,$(BOARD_FACTS))
BOARD_FOLDER := $(word 5,$(BOARD_FACTS))
# what firmware with such a clock starts with
BAUD ?= $(if $(filter 16000000,$(CPU_HZ)),115200,57600)
