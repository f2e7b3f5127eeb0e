"""Small vibrations about rest: natural frequencies and shapes, and joints from measured ones."""
