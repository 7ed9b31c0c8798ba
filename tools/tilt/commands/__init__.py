"""One module for each sub-command of `tilt`.

Each has NAME (as typed), SUMMARY (one line of `tilt --help`), arguments(parser), which adds its options, and run(args), which returns an
exit status or None for 0. What takes long to import (matplotlib, pandas, scipy) is imported within run, so that `tilt --help` is quick. A
file or an option that cannot be used raises tilt.errors.TiltError.
"""
