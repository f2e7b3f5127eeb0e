"""Independent computations that the package's own are held against."""
