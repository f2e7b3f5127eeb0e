"""Many convex bodies in space: joints of plane faces, the bed between any two bodies, and their motion to the ground."""
