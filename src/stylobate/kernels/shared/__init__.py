"""Common to the engines in the plane and in space: lists of contacts, laws and records of links, the frame of a run."""
