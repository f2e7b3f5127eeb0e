"""Models, each a frozen set of parameters with its assumptions, limits and references."""
