"""Any set of convex bodies in the plane: contact search, joints, bed, step and ledger."""
