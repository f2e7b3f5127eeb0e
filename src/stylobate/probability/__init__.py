"""Probability: limit states over records, fragility, risk, and what a measure is worth."""
