"""Structural and parametric synthesis of the polynomial filters of papers 000 and 001: `python tools/design --help`."""
