"""Rigid blocks with interfaces: the model and the stack that the static analyses use too."""
