"""Engines: compiled loops over arrays and floats, no Python objects."""
