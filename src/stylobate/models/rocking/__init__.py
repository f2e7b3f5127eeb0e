"""Housner's rocking block: the model, its closed forms, and the lanes that step it."""
