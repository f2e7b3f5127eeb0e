"""Housner's rocking block: the model, its closed forms, the batch and the adaptive single run."""
