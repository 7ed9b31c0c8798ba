"""Recordings of an ADXL345 in the formats that people use, read into our stream: t_us and x, y, z in LSB.

    source   bytes of a file: refuses what is no recording, cuts text into blocks of lines
    forms    what stands around the numbers of a line: a clock, a keyword, Python's b'...', NAME = VALUE
    columns  which column is what, from a header, from options, or from the numbers
    text     lines to readings
    jsons    JSON lines and Edge Impulse's JSON
    cwa      the AX3's binary blocks
    clock    times to microseconds
    units    values to LSB, and how sure that is
    report   what a person is told
"""
