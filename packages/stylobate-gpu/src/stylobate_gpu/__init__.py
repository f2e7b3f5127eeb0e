"""Kernels for graphics cards: indices, barriers and sums around the laws that the loops over lanes call."""
