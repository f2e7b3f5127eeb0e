"""What all models share: ground motion, energy ledger, stable step, settling, blocks of lanes."""
