"""One module per sub-command of `tilt`.

Each has NAME (as typed), SUMMARY (one line of `tilt --help`), arguments(parser), which adds its options, and run(args), which returns an
exit status, or None for 0. Slow imports (matplotlib, pandas, scipy) are in run, so that `tilt --help` is quick. A file or an option that
cannot be used raises tilt.errors.TiltError.
"""
