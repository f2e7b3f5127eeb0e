"""What joints lose, from a measured free rocking or wobbling of a column."""
