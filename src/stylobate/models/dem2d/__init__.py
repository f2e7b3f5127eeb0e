"""Plane distinct elements: the model; its engine is in ``plane``."""
