"""`tilt board`: twenty checks of a real board that its owner does by hand while the program watches the serial line.

checks.py is the table, judges_*.py the checks, watch.py their common part; bench.py has the line and the owner, session.py runs the table,
record.py keeps the results.
"""
