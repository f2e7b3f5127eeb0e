"""The rocking block of Housner: step, impacts and lanes."""
