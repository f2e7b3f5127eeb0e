"""Bodies in space of which any two may touch: from bodies as plain numbers to the arrays of their kernels, and runs."""
