"""Codes: their spectra, records for them, and their checks."""
