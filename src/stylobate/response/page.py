"""A response as a notebook shows it: the sentence, the measures, and a strip of what stood."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .. import notebook
from .instants import ASIDE, size_of, telling_states
from .summary import summary_of
from .words import sentence_of, title_of

if TYPE_CHECKING:
    from .recorded import Recorded

_LEFT_OUT = ("outcome", "reason", "wall_s", "model", "version", "mechanism", "collapse")


def as_html(response: Recorded) -> str:
    """HTML without scripts and without anything from the network."""
    facts = {key: value for key, value in summary_of(response).items() if key not in _LEFT_OUT}
    return notebook.page(title_of(response), sentence_of(response), facts, _strip(response))


def _strip(response: Recorded) -> str:
    """The telling states beside one another, in one scale, as a picture."""
    states, bodies = telling_states(response), response.bodies
    panels = [[(response.outline(k, i), bool(bodies.fixed[i])) for i in bodies.shown] for k in states]
    return notebook.silhouettes(panels, [f"{response.time[k]:.2f} s" for k in states], ASIDE * size_of(response))
