"""The `tilt` command: work on ADXL345 recordings on the PC, one sub-command per job."""

ROBUST, PLAIN = "sprf", "kf"  # recordings are judged with these: one filter with a gate, one that accepts every reading
