"""What we believe: the models, each a frozen set of parameters with its assumptions, limits and references."""
