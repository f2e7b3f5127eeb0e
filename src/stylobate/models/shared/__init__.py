"""Rooms that all models share: ground motion, energy ledger, stable step, settling, warnings, blocks of lanes."""
