"""What engines in the plane and in space share: lists of contacts, laws and records of links, the frame of every run."""
