"""Ends of a run: integer codes shared with the kernels, each with its name and its sentence.

The definitions hold for every model:

* ``at_rest``: no joint opened by more than ``OPENING_RATIO`` of its width, and no drum shifted for good.
* ``rocked``: a joint opened, and at the end no drum is shifted by more than ``SHIFT_RATIO`` of its joint's width.
* ``displaced``: the column stands, with at least one drum shifted by more than ``SHIFT_RATIO`` of its joint's width.
* ``collapsed``: the centroid of a part of the column has left its support for good (see each model's definition).
* ``failed``: the computation could not go on, its energy is out of balance, or the column does what the model cannot
  follow. Never counted as collapse.
"""

from enum import IntEnum

from .messages import say

#: A joint counts as opened when its peak opening exceeds this share of its width [-].
OPENING_RATIO: float = 1.0e-6

#: A drum counts as displaced when its residual slip exceeds this share of its joint's width [-].
SHIFT_RATIO: float = 1.0e-3


class Outcome(IntEnum):
    """Outcome of a run. ``str(outcome)`` is the name used in files and on the command line."""

    AT_REST = 0
    ROCKED = 1
    DISPLACED = 2
    COLLAPSED = 3
    FAILED = 4

    @property
    def label(self) -> str:
        """Name used in files and on the command line, e.g. ``at_rest``."""
        return self.name.lower()

    @property
    def sentence(self) -> str:
        """One sentence for a person."""
        return _SENTENCES[self]

    def sentence_of(self, drums: int) -> str:
        """The same of a column with so many drums: a monolith has none that could be shifted."""
        return _OF_A_MONOLITH.get(self, self.sentence) if drums == 1 else self.sentence

    def __str__(self) -> str:
        return self.label


_SENTENCES = {
    Outcome.AT_REST: say("The column stood still: no joint opened."),
    Outcome.ROCKED: say("The column rocked and stands: joints opened and closed, no drum is shifted."),
    Outcome.DISPLACED: say("The column stands, but at least one drum is shifted for good."),
    Outcome.COLLAPSED: say("The column collapsed."),
    Outcome.FAILED: say("The computation could not be completed; this is no verdict on the column."),
}

_OF_A_MONOLITH = {
    Outcome.AT_REST: say("The block stood still: its joint did not open."),
    Outcome.ROCKED: say("The block rocked and stands: its joint opened and closed, it is not shifted."),
    Outcome.DISPLACED: say("The block stands, but is shifted for good."),
    Outcome.COLLAPSED: say("The block collapsed."),
}


def classify(collapsed: bool, failed: bool, opening_ratio: float, shift_ratio: float) -> Outcome:
    """Outcome from the facts of a run.

    Parameters
    ----------
    collapsed, failed : bool
        As found by the model.
    opening_ratio : float
        Largest peak joint opening over joint width [-].
    shift_ratio : float
        Largest residual joint slip over joint width [-].
    """
    if failed:
        return Outcome.FAILED
    if collapsed:
        return Outcome.COLLAPSED
    if shift_ratio > SHIFT_RATIO:
        return Outcome.DISPLACED
    if opening_ratio > OPENING_RATIO:
        return Outcome.ROCKED
    return Outcome.AT_REST
