"""Plane distinct elements: the step of joints with contact points."""
