"""What a person does on the PC with recordings of the ADXL345: one command, `tilt`, with a sub-command for each job."""
