"""What all models share: blocks of lanes."""
