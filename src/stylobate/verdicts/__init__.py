"""Verdicts: does it stand, from which amplitude on, under which motions, and how sure that is."""
