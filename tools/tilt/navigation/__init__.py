"""Flights through the navigation filter: simulate, read and write them, run them on a board or in the simulator, judge and draw the result.

Axes: n is north east down, b is forward right down. A quaternion is scalar first and turns b into n. Times are microseconds.
"""
