"""Reads ADXL345 recordings in the formats of other programs into our stream: t_us and x, y, z in LSB.

    source   bytes of a file: rejects what is not a recording, cuts text into blocks of lines
    forms    what surrounds the numbers of a line: a clock, a keyword, Python's b'...', NAME = VALUE
    columns  the meaning of each column, from a header, from options, or from the numbers
    text     lines to readings
    jsons    JSON lines and Edge Impulse's JSON
    cwa      the AX3's binary blocks
    clock    times to microseconds
    units    values to LSB, and how certain that is
    report   the messages of an import
"""
