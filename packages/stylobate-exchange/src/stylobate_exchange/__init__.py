"""Doors to other tools: results and models written for them, models of theirs read."""
