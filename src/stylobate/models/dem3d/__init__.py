"""Distinct elements in space: parameters and packing, blocks of lanes, starts from a pose, verdicts."""
