"""Plane distinct elements: the model, columns as found, and columns followed to the ground."""
