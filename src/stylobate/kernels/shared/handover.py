"""How a joint of two faces hands over to the bed under an edge, as it tilts and its overlap grows small."""

from ..jit import law

#: A joint acts alone as long as the overlap is more than this share of the smaller face, the bed alone below the second.
OVERLAP_FROM, OVERLAP_TO = 0.05, 0.01


@law
def handover(c, over, h):
    """Weight of the joint's law: 1 while it acts alone, 0 when the bed does, linear in cosine and overlap between."""
    turned = (c - h.to_c) / (h.from_c - h.to_c)
    overlap_share = (over - OVERLAP_TO * h.width) / ((OVERLAP_FROM - OVERLAP_TO) * h.width)
    return min(max(min(turned, overlap_share), 0.0), 1.0)
