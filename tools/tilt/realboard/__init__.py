"""`tilt board`: twenty checks of a real board that its owner does by hand while the program watches the serial line.

checks.py is the table, judges_*.py what is watched for, watch.py what they share; bench.py has the line and the owner, session.py runs the
table, record.py keeps what came out.
"""
