"""Bodies in the plane in numbers: packed for the engine, advanced in blocks of lanes, followed to the ground."""
