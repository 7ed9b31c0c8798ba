"""What a person does on the PC with recordings of the ADXL345: one command, `tilt`, with a sub-command for each job."""

ROBUST, PLAIN = "sprf", "kf"  # what recordings are judged by: the filter with a gate, and the one that takes every reading
