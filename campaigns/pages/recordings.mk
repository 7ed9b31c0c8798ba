# The filters on real recordings, which are not part of this repository.

## recordings: run the filters on real recordings (RECORDINGS=folder, else ../shared/streams), into docs/results/recordings.md (2 minutes)
recordings:
	@sh tools/deps.sh test
	@$(MAKE) $(H)/recordings
	@python3 campaigns/pages/recordings.py

.PHONY: recordings
