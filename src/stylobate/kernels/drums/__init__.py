"""Stacks of drums over lanes: contact law, step of a lane, ledger and verdict that dem2d and rigid_block share."""
