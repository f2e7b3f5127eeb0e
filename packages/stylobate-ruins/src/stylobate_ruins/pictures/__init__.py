"""Pictures of this package, in the style of stylobate's own."""
