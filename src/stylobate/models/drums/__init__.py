"""Models of stacked drums that are stepped explicitly: options, packing, lanes and verdict that they share."""
