"""Rigid blocks with interfaces: the interface law, the dynamic step and the static equilibrium."""
